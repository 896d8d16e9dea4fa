#include "studio/page.h"

namespace gloam::studio {

web::Answer answer_page_request(const web::RequestFacts& request, const std::string& token) {
  const std::string cookie = web::cookie_name(request.port);
  const web::Verdict verdict = web::judge(request, token, cookie);
  if (verdict.status != 200) return {verdict.status, verdict.reason};
  constexpr auto kControl = web::Access::kControl;
  const std::string_view path = web::target_path(request.target);
  if (request.websocket && path == "/ws") return {.access = kControl};
  if (request.websocket) return {404, "The WebSocket is at /ws.\n", kControl};
  const PageFile* file = find_page_file(path);
  if (file == nullptr) return {404, "There is nothing at this address.\n", kControl};
  web::Answer answer = {200, file->bytes, kControl, {}, file->type};
  if (verdict.set_cookie)
    answer.cookie = cookie + "=" + token + "; Path=/; HttpOnly; SameSite=Strict";
  return answer;
}

}  // namespace gloam::studio
