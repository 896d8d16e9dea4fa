// Operations on the scene as text: its options, or all of it.

#include "bridge/zmq/operations/operation.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

Status options(const Call& call, Packer& out) {
  const std::vector<OptionInfo> all = call.services.operations().options();
  out.pack_array(static_cast<uint32_t>(all.size()));
  for (const OptionInfo& option : all) {
    out.pack_map(6);
    pack_pair(out, "path", option.path);
    pack_pair(out, "value", option.value);
    pack_pair(out, "unit", option.unit);
    pack_pair(out, "low", option.low);
    pack_pair(out, "high", option.high);
    pack_pair(out, "choices", option.choices);
  }
  return {};
}

Status get_option_text(const Call& call, Packer& out) {
  GLOAM_TRY(const std::string value,
            call.services.operations().option(call.arguments.text("path")));
  out.pack_map(1);
  pack_pair(out, "value", value);
  return {};
}

Status set_options(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().set_options(call.arguments.text_map("options")));
  pack_nothing(out);
  return {};
}

Status recompile(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().recompile(call.arguments.text("toml")));
  pack_nothing(out);
  return {};
}

}  // namespace

std::vector<Operation> option_operations() {
  return {
      {"options", "options of the scene: [{path, value, unit, …}]", kQueued, {}, options},
      {"get_option",
       "one option as TOML: {value}",
       kQueued,
       {{"path", kText, true, "", "sim.duration, camera.NAME.width …"}},
       get_option_text},
      {"set_options",
       "changes options, all or none; the scene is recompiled and the run continues",
       kQueued,
       {{"options", kTextMap, true, "", "path -> value as TOML"}},
       set_options},
      {"recompile",
       "continues in another scene; elements with the same name keep their state",
       kQueued,
       {{"toml", kText, true, "", "the whole scene file"}},
       recompile},
  };
}

}  // namespace gloam::bridge::zeromq
