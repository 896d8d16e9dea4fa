#pragma once
// The view: one web page on loopback that shows a running Simulation and lets its user pause, step,
// push and look around; and the pictures that it sends. The protocol between page and server is in
// docs/view_protocol.md.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/simulation.h"

namespace gloam {

class LogPlayer;  // gloam/log_player.h

struct ViewOptions {
  int port = 8080;                 ///< 0 = any free port, else 1 … 65535
  std::string host = "127.0.0.1";  ///< a loopback name only: 127.x.y.z, localhost or ::1
  int max_clients = 32;            ///< open connections, watching or not, 1 … 1024
  std::string camera = "free";     ///< shown first: full name, or "free"
  RenderOptions render = {.tier = "direct", .spp = 1, .denoise = false};
  int width = 0, height = 0;    ///< [px]; 0 = the camera's own
  double rate = 20;             ///< pictures per second of simulation time, (0, 240]
  Pace pace = Pace::kRealTime;  ///< that the page sets
  double speed = 1;             ///< simulated seconds per second, 0.001 … 100
  LogPlayer* player = nullptr;  ///< whose simulation it is: the page goes about in time
};

/// Serves the page from threads of its own until stopped or destroyed. The Simulation and the
/// LogPlayer must live longer. Thread-safe.
class ViewServer {
 public:
  /// Starts to listen and sets the pace; whether the simulation runs or is
  /// paused stays as it is. Errors: usage (host is not loopback, a number out of range), I/O (port
  /// in use), what open_camera says.
  static Result<std::unique_ptr<ViewServer>> start(Simulation& simulation,
                                                   const ViewOptions& options);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;
  /// Stops.
  ~ViewServer();

  /// Address for the browser, token included: a secret, print it for the user and nowhere else.
  std::string url() const;
  int port() const;
  /// Tells the clients, lets go of a dragged body and joins the threads; at once the second time.
  void stop();

 private:
  class Impl;
  explicit ViewServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Baseline JPEG, 4:2:0, of 8-bit sRGB (height x width x 3). `quality` 1 … 100. Errors: `rgb` does
/// not have the size of the picture, a side is not 1 … 65500 px, no memory.
Result<std::vector<uint8_t>> encode_jpeg(int width, int height, std::span<const uint8_t> rgb,
                                         int quality = 88);

}  // namespace gloam
