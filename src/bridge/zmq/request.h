#pragma once
// Requests of clients: {op, id, token, args} as msgpack, read within limits, and their answers
// {id, result} or {id, error}. Bytes may be a stranger's.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "bridge/zmq/pack.h"
#include "gloam/result.h"

namespace gloam::bridge::zeromq {

inline constexpr size_t kMaxRequestBytes = size_t{16} << 20;
inline constexpr int kMaxDepth = 8;            ///< of arrays and maps in one another
inline constexpr size_t kMaxNameBytes = 4096;  ///< of names, of ids and of tokens

/// Longest request that is parsed before its token is known to be right [bytes].
inline constexpr size_t kMaxUnauthenticatedBytes = 4096;

struct Request {
  std::string operation;
  std::string token;                                    ///< empty = none
  msgpack::object id;                                   ///< integer, text or nil: echoed
  msgpack::object arguments;                            ///< a map; its keys are texts
  std::shared_ptr<msgpack::object_handle> memory = {};  ///< of `id` and `arguments`
};

/// Errors: no msgpack, more than one value, deeper or larger than the limits, no map of {op …}, a
/// key that is unknown, of another type or there twice.
Result<Request> parse_request(std::span<const uint8_t> bytes);

/// The token of a request, found without making its values; "" where there is none, or bytes that
/// are no request. Takes no memory, whatever the bytes hold.
std::string_view peek_token(std::span<const uint8_t> bytes);

/// {id, error}.
PackBuffer error_reply(const msgpack::object& id, const Error& error);
/// {id, result}; `result` is one packed value.
PackBuffer result_reply(const msgpack::object& id, const PackBuffer& result);

}  // namespace gloam::bridge::zeromq
