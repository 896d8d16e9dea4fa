#pragma once
// Sends pictures to all clients, each in the codec that it asked for; each codec is encoded once.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gloam/view.h"
#include "studio/picture.h"
#include "web/websocket_server.h"

namespace gloam::studio {

class PictureSender {
 public:
  /// `slot`: of the clients' outboxes. `rate`: pictures per second, about.
  PictureSender(size_t slot, double rate) : slot_(slot), rate_(rate) {}

  /// A new client is sent the newest picture, as a JPEG until it asks for another codec.
  void add(const web::ClientPtr& client);
  void remove(int64_t client);
  void set_codec(int64_t client, Codec codec);
  /// Encodes and sends. Without clients it keeps the frame for the first one.
  void send(const RenderedFrame& rendered);
  /// Why the last picture could not be encoded; "" = it was.
  std::string error() const;

 private:
  using Bytes = std::shared_ptr<const std::vector<uint8_t>>;
  struct Viewer {
    web::ClientPtr client;
    Codec codec = Codec::kJpeg;
    bool needs_key = true;  ///< a packet of its video was lost, or none has been sent
  };
  bool wants(Codec codec) const;
  Bytes jpeg();
  void send_video();
  Result<VideoEncoder::Packet> encode_video();

  const size_t slot_;
  const double rate_;
  mutable std::mutex mutex_;  // guards all
  std::map<int64_t, Viewer> viewers_;
  RenderedFrame newest_;
  Bytes jpeg_;  // of newest_; null = not encoded
  std::unique_ptr<VideoEncoder> video_;
  int video_width_ = 0, video_height_ = 0;
  std::string error_;
};

}  // namespace gloam::studio
