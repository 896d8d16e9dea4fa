// Whatever a client sends: a message is read or refused, and refused with a reason.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "studio/messages.h"
#include "web/access.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam::studio;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto message = parse_message(text);
  if (!message.ok() && message.error().message.empty()) std::abort();
  if (message.ok()) {
    if (const auto* step = std::get_if<StepMessage>(&*message);
        step && (step->count < 1 || step->count > kMaxStepCount))
      std::abort();
    if (const auto* speed = std::get_if<SpeedMessage>(&*message);
        speed && !(speed->value >= kMinSpeed && speed->value <= kMaxSpeed))
      std::abort();
  }
  // No header without the token lets anybody in.
  const web::Verdict verdict = web::judge({.method = "GET",
                                           .target = text,
                                           .host = "localhost",
                                           .cookie = text,
                                           .authorization = text,
                                           .hosts = 1},
                                          "5ac2f1e04b7d", "gloam_view_1");
  if (verdict.status == 200 && text.find("5ac2f1e04b7d") == std::string_view::npos) std::abort();
  (void)web::judge({.method = "GET", .target = "/", .host = text, .origin = text, .hosts = 1}, "t",
                   "c");
  return 0;
}
