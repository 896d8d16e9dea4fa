#pragma once
// The view: a web page on loopback that shows a running Simulation and lets its user pause, step,
// push bodies and move the camera; and the encoders of its images. docs/view_protocol.md describes
// the protocol between page and server.

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
  int max_clients = 32;            ///< limit of open connections, 1 … 1024
  std::string camera = "free";     ///< initial camera: full name, or "free"
  RenderOptions render = {.tier = RenderTier::kInteractive};
  int width = 0, height = 0;    ///< [px]; 0 = the camera's own
  double rate = 20;             ///< images per second of simulation time, (0, 240]
  Pace pace = Pace::kRealTime;  ///< pace that the server sets
  double speed = 1;             ///< simulated seconds per second, 0.001 … 100
  LogPlayer* player = nullptr;  ///< player of the simulation, for a time line in the page
};

/// Serves the page from its own threads until it is stopped or destroyed. The Simulation and the
/// LogPlayer must outlive it. Thread-safe.
class ViewServer {
 public:
  /// Starts to listen and sets the pace; does not pause or resume the simulation. Errors: usage
  /// (host is not loopback, a number out of range), I/O (port in use), as for open_camera.
  static Result<std::unique_ptr<ViewServer>> start(Simulation& simulation,
                                                   const ViewOptions& options);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;
  /// Calls stop().
  ~ViewServer();

  /// Address for the browser, including the token. It is a secret: show it to the user only.
  std::string url() const;
  int port() const;
  /// Notifies the clients, releases a dragged body and joins the threads. A second call returns
  /// immediately.
  void stop();

 private:
  class Impl;
  explicit ViewServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Baseline JPEG, 4:2:0, of 8-bit sRGB (height x width x 3). `quality` 1 … 100. Errors: `rgb` does
/// not have the size of the image, a side is not 1 … 65500 px, no memory.
Result<std::vector<uint8_t>> encode_jpeg(int width, int height, std::span<const uint8_t> rgb,
                                         int quality = 88);

/// Encodes a sequence of 8-bit sRGB images as H.264, High profile, as a byte stream (ISO/IEC
/// 14496-10, Annex B) with BT.709 colours: constant quality, no reordering, so that each packet is
/// one image.
class VideoEncoder {
 public:
  struct Packet {
    std::vector<uint8_t> bytes;
    bool is_key = false;  ///< decodable without earlier packets
  };
  /// Odd sizes are encoded with the last row or column repeated. `rate`: images per second, about.
  /// Errors: below 16 x 16 or above 9,437,184 pixels, no memory.
  static Result<std::unique_ptr<VideoEncoder>> create(int width, int height, double rate);
  virtual ~VideoEncoder() = default;
  /// `rgb`: (height x width x 3). `key`: requests a packet that is decodable without earlier ones;
  /// the first always is. Errors: another size, no memory.
  virtual Result<Packet> encode(std::span<const uint8_t> rgb, bool key) = 0;
};

}  // namespace gloam
