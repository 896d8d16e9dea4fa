#include "web/connection.h"

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "web/request_facts.h"

namespace gloam::web {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
namespace net = boost::asio;
using beast::error_code;

constexpr uint32_t kMaxHeader = 8 << 10;
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

Connection::Connection(net::ip::tcp::socket socket, ServerState& state)
    : state_(state), stream_(std::move(socket)), last_moment_(stream_.get_executor()) {
  state_.connections.insert(this);
  half_open_ = state_.half_open.enter([this] { stream_.close(); });
}

Connection::~Connection() {
  try {
    leave();
  } catch (const std::exception&) {
    // Out of memory: the events do not learn of its end, but its outbox takes nothing.
  }
  state_.half_open.leave(half_open_);
  if (access_ != Access::kNone) --state_.admitted[access_];
  state_.connections.erase(this);
  if (state_.connections.empty() && state_.on_empty) state_.on_empty();
}

void Connection::read_request() {
  request_.emplace();
  request_->header_limit(kMaxHeader);
  // One deadline for the whole header: sending it byte by byte gains no time.
  stream_.expires_after(patience());
  http::async_read_header(
      stream_, buffer_, *request_,
      [self = shared_from_this()](error_code error, size_t) { self->on_request(error); });
}

void Connection::on_request(error_code error) {
  if (error == http::error::header_limit) return refuse(431, "The header is too long.");
  if (error == http::error::end_of_stream || error == beast::error::timeout ||
      (error && error.category() == net::error::get_system_category()))
    return;
  if (error) return refuse(400, "This is not an HTTP request.");
  const RequestFacts facts = facts_of(request_->get(), state_.port);
  const Answer answer = state_.events->answer(facts);
  if (answer.access == Access::kNone) return refuse(answer.status, answer.body);
  if (!admit(answer.access)) return refuse(503, "The server has reached its limit on clients.");
  if (!request_->is_done()) return refuse(413, "Requests to this server must not have a body.");
  if (answer.status == 101) return become_websocket(answer);
  respond(answer, request_->get().keep_alive() && !facts.websocket);
}

/// Each access has a limit of its own, so that clients without the token keep nobody out who has
/// it. False: too many connections have this access.
bool Connection::admit(Access access) {
  if (access == access_) return true;
  int& admitted = state_.admitted[access];
  if (admitted >= state_.options.max_clients) return false;
  ++admitted;
  if (access_ != Access::kNone) --state_.admitted[access_];
  access_ = access;
  state_.half_open.leave(half_open_);
  return true;
}

std::chrono::milliseconds Connection::patience() const {
  const std::chrono::milliseconds time = state_.options.request_time;
  return access_ != Access::kNone ? time : std::min(time, HalfOpen::kHeaderTimeout);
}

void Connection::refuse(int status, std::string_view reason) {
  respond({.status = status, .body = std::string(reason) + "\n"}, false);
}

void Connection::respond(const Answer& answer, bool keep_alive) {
  auto& response = response_.emplace(static_cast<http::status>(answer.status), 11);
  add_safety_fields(response);
  response.set(http::field::content_type, beast_view(answer.type));
  if (answer.status == 401) response.set(http::field::www_authenticate, "token realm=\"gloam\"");
  if (answer.status == 405) response.set(http::field::allow, state_.options.methods);
  if (answer.status == 426) response.set(http::field::upgrade, "websocket");
  if (!answer.cookie.empty()) response.set(http::field::set_cookie, answer.cookie);
  response.keep_alive(keep_alive);
  response.content_length(answer.body.size());
  if (request_->get().method() != http::verb::head) response.body() = answer.body;
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
void Connection::drain() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(4096),
                          [self = shared_from_this()](error_code error, size_t size) {
                            self->drained_ += size;
                            if (!error && self->drained_ < kMaxDrained) self->drain();
                          });
}

void Connection::become_websocket(const Answer& answer) {
  const ServerOptions& options = state_.options;
  stream_.expires_never();
  websocket_.emplace(std::move(stream_));
  websocket_->set_option(
      websocket::stream_base::timeout{options.request_time, options.idle_time, true});
  if (!answer.protocol.empty())
    websocket_->set_option(websocket::stream_base::decorator(
        [name = answer.protocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, beast_view(name));
        }));
  websocket_->read_message_max(access_ == Access::kControl ? options.message_bytes
                                                           : options.watcher_bytes);
  websocket_->auto_fragment(false);
  buffer_.clear();
  websocket_->async_accept(request_->get(), [self = shared_from_this(), answer](error_code error) {
    if (!error && !self->closing_) self->open(answer);
  });
}

void Connection::open(const Answer& answer) {
  request_.reset();
  // The context outlives all outboxes that are open: leave() closes them.
  const auto wake = [weak = weak_from_this(), executor = websocket_->get_executor()] {
    net::post(executor, [weak] {
      if (const auto self = weak.lock()) self->pump();
    });
  };
  client_ = std::make_shared<Client>(++state_.last_client, answer, wake, state_.options.outbox);
  ++state_.clients;
  state_.events->on_open(client_);
  read_message();
}

void Connection::read_message() {
  websocket_->async_read(
      buffer_, [self = shared_from_this()](error_code error, size_t) { self->on_message(error); });
}

void Connection::on_message(error_code error) {
  if (error) return end();
  if (!closing_) deliver();
  buffer_.clear();
  buffer_.shrink_to_fit();  // a large message once is no reason to keep its memory
  read_message();
}

void Connection::deliver() {
  const auto bytes = buffer_.cdata();
  if (websocket_->got_text())
    return state_.events->on_text(client_, {static_cast<const char*>(bytes.data()), bytes.size()});
  if (!state_.options.accepts_binary)
    return close(websocket::close_code::unknown_data, "Messages to the server must be text.");
  state_.events->on_binary(client_, {static_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

void Connection::pump() {
  if (writing_ || closing_) return;
  if (client_->outbox.overflowed())
    return close(websocket::close_code::try_again_later, "The client reads too slowly.");
  writing_ = client_->outbox.next();
  if (!writing_) return;
  websocket_->text(writing_->is_text);
  const std::array<net::const_buffer, 2> buffers = {
      net::buffer(writing_->head),
      writing_->body != nullptr ? net::buffer(*writing_->body) : net::const_buffer()};
  websocket_->async_write(buffers, [self = shared_from_this()](error_code error, size_t) {
    self->writing_.reset();
    if (!error) self->pump();
  });
}

void Connection::close(websocket::close_code code, std::string_view reason) {
  if (closing_) return;
  closing_ = true;
  if (client_ == nullptr) {
    if (websocket_)
      beast::get_lowest_layer(*websocket_).close();
    else
      stream_.close();
    return;
  }
  client_->outbox.close();
  websocket_->async_close({code, beast_view(reason)},
                          [self = shared_from_this()](error_code) { self->last_moment_.cancel(); });
  // A client that does not read cannot be notified: the socket is simply closed.
  last_moment_.expires_after(kCloseTimeout);
  last_moment_.async_wait([self = shared_from_this()](error_code error) {
    if (!error) beast::get_lowest_layer(*self->websocket_).close();
  });
}

void Connection::end() {
  closing_ = true;
  last_moment_.cancel();
  // A write that waits for a client that does not read would wait on.
  beast::get_lowest_layer(*websocket_).close();
  leave();
}

/// Nobody is notified of clients that are still connected when the server has stopped.
void Connection::leave() {
  const ClientPtr client = std::exchange(client_, nullptr);
  if (client == nullptr) return;
  client->outbox.close();
  state_.dropped += client->outbox.dropped();
  --state_.clients;
  if (state_.events != nullptr) state_.events->on_close(client);
}

}  // namespace gloam::web
