#include "instant/medium_field.h"

#include <vector>

#include "base/vec.h"

namespace gloam {
namespace {

VolumeGrid between(const VolumeGrid& before, const VolumeGrid& after, float share) {
  if (before == nullptr || after == nullptr) return before;
  auto out = std::make_shared<std::vector<float>>(before->size());
  for (size_t i = 0; i < out->size(); ++i) (*out)[i] = lerp((*before)[i], (*after)[i], share);
  return out;
}

}  // namespace

void FieldWindow::read(VolumeGrid* density, VolumeGrid* temperature, VolumeGrid* flame) const {
  if (before == nullptr) {
    *density = *temperature = *flame = nullptr;
    return;
  }
  before->wait();
  *density = before->density();
  *temperature = before->temperature();
  *flame = before->flame();
  if (share == 0) return;
  after->wait();
  if (after->density() == before->density()) return;
  *density = between(before->density(), after->density(), share);
  *temperature = between(before->temperature(), after->temperature(), share);
  *flame = between(before->flame(), after->flame(), share);
}

}  // namespace gloam
