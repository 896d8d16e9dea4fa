#include "bridge/zmq/operations/operation.h"

#include <fmt/format.h>

#include <algorithm>

#include "gloam/program.h"

namespace gloam::bridge::zeromq {
namespace {

std::vector<Operation> make_table() {
  std::vector<Operation> table;
  for (auto* rows : {hello_operations, run_operations, command_operations, claim_operations,
                     option_operations, world_operations, record_operations, joint_operations}) {
    std::vector<Operation> some = rows();
    table.insert(table.end(), some.begin(), some.end());
  }
  std::ranges::sort(table, {}, &Operation::name);
  return table;
}

}  // namespace

std::span<const Operation> all_operations() {
  static const std::vector<Operation> table = make_table();
  return table;
}

Result<const Operation*> find_operation(std::string_view name) {
  const std::span<const Operation> table = all_operations();
  const auto row = std::ranges::find(table, name, &Operation::name);
  if (row != table.end()) return &*row;
  std::vector<std::string> names;
  for (const Operation& operation : table) names.emplace_back(operation.name);
  std::string remedy = suggest_name(name.substr(0, 60), names);
  if (remedy.empty()) remedy = "'hello' lists all operations";
  return Error{ErrorKind::kUsage,
               fmt::format("there is no operation '{}'", name.substr(0, 60)),
               {},
               std::move(remedy)};
}

Status pack_latest(const Call& call, Packer& out) {
  const Snapshot now = call.services.simulation().latest();
  GLOAM_TRY(const StateLayout layout, call.services.layouts.of(now));
  out.pack_map(kStatePairs);
  pack_state(out, now, layout);
  return {};
}

}  // namespace gloam::bridge::zeromq
