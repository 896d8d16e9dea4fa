#include "bridge/foxglove/connection.h"

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <string>
#include <utility>

#include "web/request_facts.h"

namespace gloam::bridge::foxglove {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
namespace net = boost::asio;
using beast::error_code;

constexpr uint32_t kMaxHeader = 8 << 10;
constexpr size_t kMaxDrained = 256 << 10;
constexpr std::chrono::seconds kCloseTimeout{2};

}  // namespace

Connection::Connection(net::ip::tcp::socket socket, ServerState& state)
    : state_(state), stream_(std::move(socket)), last_moment_(stream_.get_executor()) {
  state_.connections.insert(this);
  half_open_ = state_.half_open.enter([this] { stream_.close(); });
}

Connection::~Connection() {
  state_.half_open.leave(half_open_);
  state_.connections.erase(this);
  if (state_.connections.empty() && state_.on_empty) state_.on_empty();
}

void Connection::read_request() {
  request_.emplace();
  request_->header_limit(kMaxHeader);
  // One deadline for the whole header: sending it byte by byte gains no time.
  stream_.expires_after(std::min(state_.options.request_time, web::HalfOpen::kHeaderTimeout));
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
  const auto& request = request_->get();
  const auto protocols = web::view(request[http::field::sec_websocket_protocol]);
  const Admission admission = admit(web::facts_of(request, state_.port), protocols,
                                    state_.options.token, state_.loopback_only);
  if (admission.status != 101) return refuse(admission.status, admission.reason);
  // Watchers without the token cannot keep those out who have it.
  const int alike = admission.may_control ? state_.clients - state_.watchers : state_.watchers;
  if (alike >= state_.options.max_clients)
    return refuse(503, "The server has reached its limit on clients.");
  become_websocket(admission);
}

void Connection::refuse(int status, std::string_view reason) {
  auto& response = response_.emplace(static_cast<http::status>(status), 11);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.set("X-Content-Type-Options", "nosniff");
  if (status == 401) response.set(http::field::www_authenticate, "token realm=\"gloam\"");
  if (status == 405) response.set(http::field::allow, "GET");
  if (status == 426) response.set(http::field::upgrade, "websocket");
  response.keep_alive(false);
  response.body() = std::string(reason) + "\n";
  response.prepare_payload();
  stream_.expires_after(std::min(state_.options.request_time, web::HalfOpen::kHeaderTimeout));
  http::async_write(stream_, response, [self = shared_from_this()](error_code error, size_t) {
    if (error) return;
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

void Connection::become_websocket(const Admission& admission) {
  count(admission.may_control, 1);
  state_.half_open.leave(std::exchange(half_open_, 0));
  stream_.expires_never();
  websocket_.emplace(std::move(stream_));
  websocket_->set_option(
      websocket::stream_base::timeout{state_.options.request_time, state_.options.idle_time, true});
  websocket_->set_option(websocket::stream_base::decorator(
      [name = std::string(admission.protocol.name)](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol, name);
      }));
  websocket_->read_message_max(admission.may_control ? state_.options.message_bytes
                                                     : state_.options.watcher_bytes);
  websocket_->auto_fragment(false);
  buffer_.clear();
  websocket_->async_accept(request_->get(), [self = shared_from_this(), admission](error_code e) {
    if (!e && !self->closing_) return self->open(admission);
    self->count(admission.may_control, -1);
  });
}

void Connection::open(const Admission& admission) {
  request_.reset();
  // The context outlives all outboxes that are open: end() closes them.
  const auto wake = [weak = weak_from_this(), executor = websocket_->get_executor()] {
    net::post(executor, [weak] {
      if (const auto self = weak.lock()) self->pump();
    });
  };
  client_ = std::make_shared<Client>(++state_.last_client, admission.protocol,
                                     admission.may_control, wake, state_.options.outbox);
  state_.events->on_open(client_);
  read_message();
}

void Connection::count(bool may_control, int change) {
  state_.clients += change;
  if (!may_control) state_.watchers += change;
}

void Connection::read_message() {
  websocket_->async_read(
      buffer_, [self = shared_from_this()](error_code error, size_t) { self->on_message(error); });
}

void Connection::on_message(error_code error) {
  if (error) return end();
  if (!closing_) {
    const auto bytes = buffer_.cdata();
    if (websocket_->got_text())
      state_.events->on_text(client_, {static_cast<const char*>(bytes.data()), bytes.size()});
    else
      state_.events->on_binary(client_, {static_cast<const uint8_t*>(bytes.data()), bytes.size()});
  }
  buffer_.clear();
  buffer_.shrink_to_fit();  // a large message once is no reason to keep its memory
  read_message();
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
  websocket_->async_write(buffers, [self = shared_from_this()](error_code failed, size_t) {
    self->writing_.reset();
    if (!failed) self->pump();
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
  websocket_->async_close({code, beast::string_view(reason.data(), reason.size())},
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
  const ClientPtr client = std::exchange(client_, nullptr);
  if (client == nullptr) return;
  client->outbox.close();
  state_.dropped += client->outbox.dropped();
  count(client->may_control, -1);
  state_.events->on_close(client);
}

}  // namespace gloam::bridge::foxglove
