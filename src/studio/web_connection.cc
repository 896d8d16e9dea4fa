#include "studio/web_connection.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <utility>

#include "studio/messages.h"
#include "studio/page.h"
#include "web/request_facts.h"

namespace gloam::studio {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
namespace net = boost::asio;
using beast::error_code;

constexpr uint32_t kMaxHeader = 8 << 10;
constexpr size_t kMaxMessage = 64 << 10;
constexpr size_t kMaxQueuedTexts = 128;
constexpr size_t kMaxDrained = 256 << 10;
constexpr std::chrono::seconds kCloseTimeout{2};

/// Header fields that forbid a browser unsafe uses of any answer of this server.
void add_safety_fields(http::fields& fields) {
  fields.set("Content-Security-Policy",
             "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  fields.set(http::field::cache_control, "no-store");
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("X-Frame-Options", "DENY");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Opener-Policy", "same-origin");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
}

}  // namespace

WebConnection::WebConnection(net::ip::tcp::socket socket, WebShared& shared)
    : shared_(shared), stream_(std::move(socket)), last_moment_(stream_.get_executor()) {
  shared_.connections.insert(this);
  half_open_ = shared_.half_open.enter([this] { stream_.close(); });
}

WebConnection::~WebConnection() {
  if (half_open_ != 0)
    shared_.half_open.leave(half_open_);
  else
    --shared_.admitted;
  shared_.connections.erase(this);
  if (shared_.connections.empty() && shared_.on_empty) shared_.on_empty();
}

void WebConnection::read_request() {
  request_.emplace();
  request_->header_limit(kMaxHeader);
  // One deadline for the whole header: sending it byte by byte gains no time.
  stream_.expires_after(patience());
  http::async_read_header(
      stream_, buffer_, *request_,
      [self = shared_from_this()](error_code error, size_t) { self->on_request(error); });
}

void WebConnection::on_request(error_code error) {
  if (error == http::error::header_limit) return refuse(431, "The header is too long.");
  if (error == http::error::end_of_stream || error == beast::error::timeout ||
      (error && error.category() == net::error::get_system_category()))
    return;
  if (error) return refuse(400, "This is not an HTTP request.");

  const auto& request = request_->get();
  const web::RequestFacts facts = web::facts_of(request, shared_.port);
  const web::Verdict verdict = web::judge(facts, shared_.options.token, shared_.cookie_name);
  if (verdict.status != 200) return refuse(static_cast<unsigned>(verdict.status), verdict.reason);
  if (!let_in()) return refuse(503, "The server has reached its limit on clients.");
  if (!request_->is_done()) return refuse(413, "Requests to this server must not have a body.");

  const std::string_view path = web::target_path(facts.target);
  if (facts.websocket) {
    if (path != "/ws") return refuse(404, "The WebSocket is at /ws.");
    return become_websocket();
  }
  if (const PageFile* file = find_page_file(path))
    return answer(http::status::ok, file->type, file->bytes, request.keep_alive(),
                  verdict.set_cookie);
  answer(http::status::not_found, "text/plain; charset=utf-8",
         "There is nothing at this address.\n", request.keep_alive(), false);
}

/// It has shown the token. False: too many have.
bool WebConnection::let_in() {
  if (half_open_ == 0) return true;
  if (shared_.admitted >= shared_.options.max_connections) return false;
  shared_.half_open.leave(std::exchange(half_open_, 0));
  ++shared_.admitted;
  return true;
}

std::chrono::milliseconds WebConnection::patience() const {
  const std::chrono::milliseconds time = shared_.options.request_time;
  return half_open_ == 0 ? time : std::min(time, web::HalfOpen::kHeaderTimeout);
}

void WebConnection::refuse(unsigned status, std::string_view reason) {
  answer(static_cast<http::status>(status), "text/plain; charset=utf-8", std::string(reason) + "\n",
         false, false);
}

void WebConnection::answer(http::status status, std::string_view type, std::string_view body,
                           bool keep_alive, bool set_cookie) {
  auto& response = response_.emplace(status, 11);
  add_safety_fields(response);
  response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  if (status == http::status::unauthorized)
    response.set(http::field::www_authenticate, "token realm=\"gloam\"");
  if (status == http::status::method_not_allowed) response.set(http::field::allow, "GET, HEAD");
  if (set_cookie)
    response.set(http::field::set_cookie, shared_.cookie_name + "=" + shared_.options.token +
                                              "; Path=/; HttpOnly; SameSite=Strict");
  response.keep_alive(keep_alive);
  response.content_length(body.size());
  if (request_->get().method() != http::verb::head) response.body() = body;

  stream_.expires_after(patience());
  http::async_write(stream_, response,
                    [self = shared_from_this(), keep_alive](error_code error, size_t) {
                      if (error) return;
                      if (keep_alive) return self->read_request();
                      self->stream_.socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
                      self->stream_.expires_after(kCloseTimeout);
                      self->drain();
                    });
}

/// Closing with unread bytes would reset the connection and take the answer from the client.
void WebConnection::drain() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(4096),
                          [self = shared_from_this()](error_code error, size_t size) {
                            self->drained_ += size;
                            if (!error && self->drained_ < kMaxDrained) self->drain();
                          });
}

void WebConnection::become_websocket() {
  stream_.expires_never();
  websocket_.emplace(std::move(stream_));
  websocket_->set_option(websocket::stream_base::timeout{shared_.options.request_time,
                                                         shared_.options.idle_time, true});
  websocket_->read_message_max(kMaxMessage);
  websocket_->auto_fragment(false);
  buffer_.clear();
  websocket_->async_accept(request_->get(), [self = shared_from_this()](error_code error) {
    if (error) return;
    self->request_.reset();
    self->client_ = ++self->shared_.last_client;
    self->shared_.clients[self->client_] = self.get();
    self->shared_.events->on_open(self->client_);
    // After the messages of on_open.
    net::post(self->websocket_->get_executor(), [self] {
      if (self->shared_.picture) self->send_picture(self->shared_.picture);
    });
    self->read_message();
  });
}

void WebConnection::read_message() {
  websocket_->async_read(
      buffer_, [self = shared_from_this()](error_code error, size_t) { self->on_message(error); });
}

void WebConnection::on_message(error_code error) {
  if (error) return end();
  if (!closing_) {
    if (!websocket_->got_text()) {
      close(websocket::close_code::unknown_data, "Messages to the server must be text.");
    } else {
      const auto bytes = buffer_.cdata();
      shared_.events->on_text(client_, {static_cast<const char*>(bytes.data()), bytes.size()});
    }
  }
  buffer_.clear();
  read_message();
}

void WebConnection::send(std::string text) {
  if (closing_) return;
  if (texts_.size() >= kMaxQueuedTexts)
    return close(websocket::close_code::try_again_later, "The client reads too slowly.");
  texts_.push_back(std::make_shared<const std::string>(std::move(text)));
  pump();
}

void WebConnection::send_state(Text text) {
  state_ = std::move(text);
  pump();
}

void WebConnection::send_picture(Text packet) {
  picture_ = std::move(packet);
  pump();
}

void WebConnection::picture_seen() {
  if (pictures_in_flight_ > 0) --pictures_in_flight_;
  pump();
}

void WebConnection::pump() {
  if (writing_ || closing_) return;
  if (!texts_.empty()) {
    Text text = std::move(texts_.front());
    texts_.pop_front();
    write(std::move(text), true);
  } else if (state_) {
    write(std::exchange(state_, nullptr), true);
  } else if (picture_ && pictures_in_flight_ < kPicturesInFlight) {
    ++pictures_in_flight_;
    write(std::exchange(picture_, nullptr), false);
  }
}

void WebConnection::write(Text bytes, bool is_text) {
  writing_ = std::move(bytes);
  websocket_->text(is_text);
  websocket_->async_write(net::buffer(*writing_),
                          [self = shared_from_this()](error_code error, size_t) {
                            self->writing_.reset();
                            if (!error) self->pump();
                          });
}

void WebConnection::close(websocket::close_code code, std::string_view reason) {
  if (closing_) return;
  closing_ = true;
  texts_.clear();
  if (client_ == 0) {
    if (websocket_)
      beast::get_lowest_layer(*websocket_).close();
    else
      stream_.close();
    return;
  }
  websocket_->async_close({code, beast::string_view(reason.data(), reason.size())},
                          [self = shared_from_this()](error_code) { self->last_moment_.cancel(); });
  // A client that does not read cannot be notified: the socket is simply closed.
  last_moment_.expires_after(kCloseTimeout);
  last_moment_.async_wait([self = shared_from_this()](error_code error) {
    if (!error) beast::get_lowest_layer(*self->websocket_).close();
  });
}

void WebConnection::end() {
  closing_ = true;
  last_moment_.cancel();
  // A write that waits for a client that does not read would wait on.
  beast::get_lowest_layer(*websocket_).close();
  if (client_ != 0 && shared_.clients.erase(client_) > 0) shared_.events->on_close(client_);
}

}  // namespace gloam::studio
