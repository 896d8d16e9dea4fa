#include "render/scene/profile_store.h"

namespace gloam {

ProfileStore make_profile_store(const std::vector<IesProfile>& profiles) {
  ProfileStore store;
  for (const IesProfile& profile : profiles) {
    store.profiles.push_back(
        {static_cast<uint32_t>(store.values.size()), profile.rows, profile.columns});
    const float scale = profile.most > 0 ? 1 / profile.most : 0;
    for (const float candela : profile.candela) store.values.push_back(candela * scale);
  }
  return store;
}

}  // namespace gloam
