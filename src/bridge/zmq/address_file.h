#pragma once
// AddressFile: where clients of the same user on this machine find a server and its token.

#include <memory>
#include <string>

#include "gloam/result.h"

namespace gloam::bridge::zeromq {

struct ServerAddress {
  std::string operations, streams;  ///< "tcp://127.0.0.1:5556"
  int port = 0;                     ///< of operations
  std::string token, public_key;    ///< secret; CURVE's in Z85, empty = no encryption
  std::string scene;                ///< name of the scene
};

/// "boot id:user id" of this machine and user: equal for two processes that may share memory.
std::string machine_id();

/// $XDG_RUNTIME_DIR/gloam/zmq-PORT.json or /tmp/gloam-UID/zmq-PORT.json, mode 600 in a folder of
/// mode 700; removed at its end.
class AddressFile {
 public:
  /// Errors: the folder is another's or open to others, the disk.
  static Result<std::unique_ptr<AddressFile>> write(const ServerAddress& address);
  ~AddressFile();
  AddressFile(const AddressFile&) = delete;
  AddressFile& operator=(const AddressFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  explicit AddressFile(std::string path) : path_(std::move(path)) {}
  const std::string path_;
};

}  // namespace gloam::bridge::zeromq
