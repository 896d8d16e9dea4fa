// Which part of an observation goes where in the inputs of networks.

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "policy/observer.h"

namespace gloam {
namespace {

using NetworkList = std::span<const std::unique_ptr<Network>>;

std::vector<std::string> port_names(const std::vector<NetworkPort>& ports) {
  std::vector<std::string> names;
  for (const NetworkPort& port : ports) names.push_back(port.name);
  return names;
}

size_t place_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<size_t>(std::ranges::find(names, name) - names.begin());
}

Error unknown(const ObservationPart& part, std::string_view what, const std::string& name,
              const std::vector<std::string>& names) {
  return {ErrorKind::kInput, fmt::format("there is no {} '{:.80}'", what, name), part.loc,
          suggest_name(name, names)};
}

class Wiring {
 public:
  Wiring(const PolicySpec& spec, NetworkList networks) : spec_(spec), networks_(networks) {
    for (const NetworkSpec& network : spec.networks) names_.push_back(network.name);
  }

  Result<NetworkWiring> wire(size_t network) {
    const NetworkSpec& spec = spec_.networks[network];
    NetworkWiring wiring;
    for (const ObservationPart& part : spec.parts) {
      GLOAM_TRY(PartWiring wired, wire_part(network, part));
      // The network's own history has the terms of its first input; outputs of others follow it.
      wired.is_framed = spec.history > 1 && wired.input == 0 && part.kind->name != "network_output";
      if (wired.is_framed) wiring.frame += wired.size;
      wiring.parts.push_back(wired);
    }
    std::vector<size_t> ends(networks_[network]->inputs().size());
    if (wiring.frame != 0) ends[0] = wiring.frame * static_cast<size_t>(spec.history);
    size_t frame = 0;
    for (PartWiring& part : wiring.parts) {
      size_t& end = part.is_framed ? frame : ends[part.input];
      part.offset = end;
      end += part.size;
    }
    for (size_t i = 0; i < ends.size(); ++i)
      GLOAM_TRY_STATUS(check_size(network, wiring, i, ends[i]));
    return wiring;
  }

 private:
  Result<PartWiring> wire_part(size_t network, const ObservationPart& part) {
    PartWiring wired;
    const auto inputs = port_names(networks_[network]->inputs());
    if (!part.input.empty()) wired.input = place_of(inputs, part.input);
    if (wired.input >= inputs.size()) return unknown(part, "input", part.input, inputs);
    if (part.from.is_set()) GLOAM_TRY_STATUS(find_output(part, &wired));
    const size_t size = part.term->size() != 0 ? part.term->size() : wired.count;
    if (part.scale.size() != 1 && part.scale.size() != size)
      return Error{ErrorKind::kInput,
                   fmt::format("scale has {} numbers, but the part of the output has {}",
                               part.scale.size(), size),
                   part.loc};
    wired.size = size * static_cast<size_t>(part.history);
    return wired;
  }

  Status find_output(const ObservationPart& part, PartWiring* wired) {
    wired->source_network = place_of(names_, part.from.network);
    if (wired->source_network >= names_.size())
      return unknown(part, "network", part.from.network, names_);
    const std::vector<NetworkPort>& ports = networks_[wired->source_network]->outputs();
    const auto outputs = port_names(ports);
    wired->source_output = part.from.output.empty() ? 0 : place_of(outputs, part.from.output);
    if (wired->source_output >= outputs.size())
      return unknown(part, "output", part.from.output, outputs);
    const size_t size = ports[wired->source_output].size;
    wired->first = static_cast<size_t>(part.first);
    if (part.count != 0)
      wired->count = static_cast<size_t>(part.count);
    else if (wired->first < size)
      wired->count = size - wired->first;
    if (wired->count == 0 || wired->first + wired->count > size)
      return Error{ErrorKind::kInput,
                   fmt::format("output '{:.80}' has {} numbers, but elements {} to {} are required",
                               ports[wired->source_output].name, size, wired->first,
                               wired->first + wired->count),
                   part.loc};
    return {};
  }

  Status check_size(size_t network, const NetworkWiring& wiring, size_t input,
                    size_t filled) const {
    const NetworkPort& port = networks_[network]->inputs()[input];
    if (filled == port.size) return {};
    const NetworkSpec& spec = spec_.networks[network];
    std::string parts;
    for (size_t i = 0; i < wiring.parts.size(); ++i)
      if (wiring.parts[i].input == input)
        parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", spec.parts[i].kind->name,
                             wiring.parts[i].size);
    if (wiring.frame != 0 && input == 0) parts += fmt::format("; history of {}", spec.history);
    return Error{ErrorKind::kInput,
                 fmt::format("the observation terms have {} numbers, but the {} {}", filled,
                             networks_[network]->inputs().size() == 1
                                 ? std::string("network takes")
                                 : fmt::format("network's input '{:.80}' takes", port.name),
                             port.size),
                 {spec_.file, spec.loc.line, spec.loc.column},
                 parts};
  }

  const PolicySpec& spec_;
  NetworkList networks_;
  std::vector<std::string> names_;
};

}  // namespace

Result<std::vector<NetworkWiring>> wire_networks(const PolicySpec& spec, NetworkList networks) {
  std::vector<NetworkWiring> all;
  Wiring wiring(spec, networks);
  for (size_t i = 0; i < networks.size(); ++i) {
    GLOAM_TRY(NetworkWiring wired, wiring.wire(i));
    all.push_back(std::move(wired));
  }
  return all;
}

}  // namespace gloam
