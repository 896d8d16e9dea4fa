// Terms of the feet's contacts.

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "policy/policy_spec.h"
#include "policy/terms/body_pose.h"

namespace gloam {
namespace {

/// 1 for each foot that touched anything in the last step, else 0.
class ContactState final : public Term {
 public:
  explicit ContactState(std::vector<std::string> feet) : feet_(std::move(feet)) {}
  size_t size() const override { return feet_.size(); }
  Status bind(const TermBinding& binding) override;
  void write(const TermInputs& in, std::span<double> out) override {
    std::ranges::fill(out, 0.0);
    for (int c = 0; c < in.data->ncon; ++c) {
      const mjContact& contact = in.data->contact[c];
      if (contact.efc_address < 0) continue;
      for (const int geom : contact.geom) mark(geom, out);
    }
    for (const ContactLoad& load : in.loads) mark(load.geom, out);
  }
  std::unique_ptr<Term> clone() const override { return std::make_unique<ContactState>(*this); }

 private:
  void mark(int geom, std::span<double> out) const {
    if (geom >= 0 && foot_of_geom_[static_cast<size_t>(geom)] >= 0)
      out[static_cast<size_t>(foot_of_geom_[static_cast<size_t>(geom)])] = 1;
  }

  std::vector<std::string> feet_;
  std::vector<int> foot_of_geom_;  // (ngeom), -1 = of no foot
};

Status ContactState::bind(const TermBinding& binding) {
  const mjModel& model = *binding.model;
  foot_of_geom_.assign(static_cast<size_t>(model.ngeom), -1);
  for (size_t i = 0; i < feet_.size(); ++i) {
    const std::string full = full_name(*binding.robot, feet_[i]);
    const int geom = mj_name2id(&model, mjOBJ_GEOM, full.c_str());
    const int body = mj_name2id(&model, mjOBJ_BODY, full.c_str());
    if (geom < 0 && body < 0) {
      std::vector<std::string> names = names_of(model, *binding.robot, mjOBJ_GEOM);
      const auto bodies = names_of(model, *binding.robot, mjOBJ_BODY);
      names.insert(names.end(), bodies.begin(), bodies.end());
      return Error{ErrorKind::kInput,
                   fmt::format("robot '{}' has no geom or body '{:.80}', which is a foot of the "
                               "policy",
                               binding.robot->name, full),
                   {},
                   suggest_name(full, names)};
    }
    if (geom >= 0) foot_of_geom_[static_cast<size_t>(geom)] = static_cast<int>(i);
    for (int g = 0; geom < 0 && g < model.ngeom; ++g)
      if (model.geom_bodyid[g] == body) foot_of_geom_[static_cast<size_t>(g)] = static_cast<int>(i);
  }
  return {};
}

std::unique_ptr<Term> make_contact_state(const TermRequest& request) {
  if (request.spec->feet.empty())
    request.settings->fail(request.table, "contact_state needs the names of the feet",
                           "set feet = [\"FL_foot\", …] in [policy]: geoms or bodies of the model");
  return std::make_unique<ContactState>(request.spec->feet);
}

constexpr TermKind kContactTerms[] = {
    {.name = "contact_state",
     .aliases = "contact_states foot_contacts feet_contact",
     .unit = "1",
     .doc = "1 for each foot of [policy] feet that touched anything in the last step, else 0",
     .make = make_contact_state},
};

}  // namespace

std::span<const TermKind> contact_terms() { return kContactTerms; }

}  // namespace gloam
