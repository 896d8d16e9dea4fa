#include "policy/terms/terms.h"

#include <fmt/format.h>

#include "base/text.h"
#include "policy/policy_spec.h"

namespace gloam {
namespace {

/// A term that is a function of the present state.
class SimpleTerm final : public Term {
 public:
  SimpleTerm(const TermKind& kind, size_t size) : kind_(kind), size_(size) {}
  size_t size() const override { return size_; }
  void write(const TermInputs& in, std::span<double> out) override { kind_.write(in, out); }
  std::unique_ptr<Term> clone() const override { return std::make_unique<SimpleTerm>(*this); }
  bool needs_base() const override { return kind_.needs_base; }

 private:
  const TermKind& kind_;
  size_t size_;
};

bool has_word(std::string_view list, std::string_view word) {
  for (size_t begin = 0; begin < list.size();) {
    const size_t end = std::min(list.find(' ', begin), list.size());
    if (list.substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

std::span<const TermKind> term_kinds() {
  static const std::vector<TermKind> all = [] {
    std::vector<TermKind> list;
    for (const auto group : {robot_terms(), command_terms(), gait_terms(), contact_terms(),
                             ray_terms(), network_terms()})
      list.insert(list.end(), group.begin(), group.end());
    return list;
  }();
  return all;
}

const TermKind* find_term(const toml::node& name, Settings* settings) {
  const std::string word = name.value_exact<std::string>().value_or("");
  std::vector<std::string> names, words;
  for (const TermKind& kind : term_kinds()) {
    if (kind.name == word || has_word(kind.aliases, word)) return &kind;
    names.emplace_back(kind.name);
    words.emplace_back(kind.name);
    for (size_t begin = 0; begin < kind.aliases.size();) {
      const size_t end = std::min(kind.aliases.find(' ', begin), kind.aliases.size());
      words.emplace_back(kind.aliases.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  const std::string near = nearest_name(word, words);
  settings->fail(
      &name, fmt::format("there is no observation term '{:.80}'", word),
      (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) + "one of: " + joined(names));
  return nullptr;
}

std::unique_ptr<Term> make_term(const TermKind& kind, const TermRequest& request) {
  if (kind.write != nullptr)
    return std::make_unique<SimpleTerm>(kind,
                                        kind.fixed + kind.per_joint * request.spec->joints.size());
  std::unique_ptr<Term> term = kind.make(request);
  return request.settings->ok() ? std::move(term) : nullptr;
}

}  // namespace gloam
