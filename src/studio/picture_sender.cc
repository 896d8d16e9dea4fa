#include "studio/picture_sender.h"

#include <algorithm>
#include <utility>

namespace gloam::studio {

void PictureSender::add(const web::ClientPtr& client) {
  const std::lock_guard lock(mutex_);
  viewers_[client->id] = {client};
  if (newest_.frame == nullptr) return;
  if (const Bytes packet = jpeg()) client->outbox.replace(slot_, {"", packet});
}

void PictureSender::remove(int64_t client) {
  const std::lock_guard lock(mutex_);
  viewers_.erase(client);
}

void PictureSender::set_codec(int64_t client, Codec codec) {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(client);
  if (found == viewers_.end()) return;
  found->second.codec = codec;
  found->second.needs_key = true;
}

std::string PictureSender::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

bool PictureSender::wants(Codec codec) const {
  return std::ranges::any_of(viewers_,
                             [codec](const auto& entry) { return entry.second.codec == codec; });
}

void PictureSender::send(const RenderedFrame& rendered) {
  const std::lock_guard lock(mutex_);
  newest_ = rendered;
  jpeg_ = nullptr;
  error_.clear();
  if (wants(Codec::kH264)) send_video();
  if (!wants(Codec::kJpeg)) return;
  const Bytes packet = jpeg();
  if (packet == nullptr) return;
  for (auto& [id, viewer] : viewers_)
    if (viewer.codec == Codec::kJpeg) viewer.client->outbox.replace(slot_, {"", packet});
}

/// Null: it cannot be encoded; error() says why.
PictureSender::Bytes PictureSender::jpeg() {
  if (jpeg_ != nullptr) return jpeg_;
  auto packet = jpeg_packet(newest_);
  if (packet.ok()) {
    jpeg_ = std::make_shared<const std::vector<uint8_t>>(std::move(packet).value());
  } else {
    error_ = packet.error().to_string();
  }
  return jpeg_;
}

/// A client to which the last packet has not been sent yet could not decode the next one: it waits
/// for a key packet.
void PictureSender::send_video() {
  const auto coded = encode_video();
  if (!coded.ok()) {  // pictures too large or too small for video
    for (auto& [id, viewer] : viewers_) viewer.codec = Codec::kJpeg;
    return;
  }
  const auto packet = std::make_shared<const std::vector<uint8_t>>(
      make_packet(newest_, Codec::kH264, coded->is_key, coded->bytes));
  for (auto& [id, viewer] : viewers_) {
    if (viewer.codec != Codec::kH264 || (viewer.needs_key && !coded->is_key)) continue;
    web::Outbox& outbox = viewer.client->outbox;
    if (coded->is_key) {
      outbox.replace(slot_, {"", packet});
      viewer.needs_key = false;
    } else {
      viewer.needs_key = !outbox.append(slot_, {"", packet});
    }
  }
}

Result<VideoEncoder::Packet> PictureSender::encode_video() {
  const Intrinsics& k = newest_.frame->intrinsics;
  if (video_ == nullptr || video_width_ != k.width || video_height_ != k.height) {
    video_.reset();
    GLOAM_TRY(video_, VideoEncoder::create(k.width, k.height, rate_));
    video_width_ = k.width, video_height_ = k.height;
  }
  const bool key = std::ranges::any_of(viewers_, [](const auto& entry) {
    return entry.second.codec == Codec::kH264 && entry.second.needs_key;
  });
  return video_->encode(newest_.frame->rgb, key);
}

}  // namespace gloam::studio
