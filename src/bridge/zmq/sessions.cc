#include "bridge/zmq/sessions.h"

#include <fmt/format.h>

namespace gloam::bridge::zeromq {
namespace {

using std::chrono::seconds;

constexpr seconds kSessionTimeout{10};
constexpr size_t kMaxSessions = 1024;
constexpr size_t kMaxClaims = 64;

}  // namespace

void Sessions::note(const Envelope& client) {
  const std::lock_guard lock(mutex_);
  if (sessions_.size() >= kMaxSessions) forget_silent();
  if (sessions_.size() >= kMaxSessions && !sessions_.contains(client.client)) return;
  Session& session = sessions_[client.client];
  session.client = client;
  session.last_seen = Clock::now();
}

void Sessions::forget_silent() {
  const auto now = Clock::now();
  std::erase_if(sessions_, [now](const auto& each) {
    return each.second.leases.empty() && now - each.second.last_seen > kSessionTimeout;
  });
}

int Sessions::count() const {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  int present = 0;
  for (const auto& [id, session] : sessions_)
    if (!session.leases.empty() || now - session.last_seen <= kSessionTimeout) ++present;
  return present;
}

Status Sessions::claim(const Envelope& client, const std::string& robot) {
  GLOAM_TRY(const Robot handle, simulation_.world().find_robot(robot));
  const std::lock_guard lock(mutex_);
  Session& session = sessions_[client.client];
  session.client = client;
  if (session.leases.contains(robot)) return {};
  if (session.leases.size() >= kMaxClaims)
    return Error{ErrorKind::kUsage,
                 fmt::format("a client can claim at most {} robots", kMaxClaims)};
  GLOAM_TRY(std::unique_ptr<ControlLease> lease, simulation_.claim(handle));
  session.leases[robot] = std::move(lease);
  return {};
}

Status Sessions::release(const std::string& client, const std::string& robot) {
  const std::lock_guard lock(mutex_);
  const auto session = sessions_.find(client);
  if (session == sessions_.end() || session->second.leases.erase(robot) == 0)
    return Error{ErrorKind::kUsage, fmt::format("you have not claimed '{:.60}'", robot)};
  return {};
}

void Sessions::end(const std::string& client) {
  const std::lock_guard lock(mutex_);
  sessions_.erase(client);
}

std::vector<std::string> Sessions::claims(const std::string& client) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> robots;
  if (const auto session = sessions_.find(client); session != sessions_.end())
    for (const auto& [robot, lease] : session->second.leases) robots.push_back(robot);
  return robots;
}

std::vector<Envelope> Sessions::holders() const {
  const std::lock_guard lock(mutex_);
  std::vector<Envelope> holders;
  for (const auto& [id, session] : sessions_)
    if (!session.leases.empty()) holders.push_back(session.client);
  return holders;
}

Status Sessions::post(const std::string& client, const std::string& robot,
                      std::span<const Command> commands) {
  const std::lock_guard lock(mutex_);
  const auto session = sessions_.find(client);
  if (session != sessions_.end())
    if (const auto lease = session->second.leases.find(robot);
        lease != session->second.leases.end())
      return lease->second->post(commands);
  return simulation_.post(commands);
}

}  // namespace gloam::bridge::zeromq
