#pragma once
// Photometric profiles as the kernel reads them.

#include <vector>

#include "render/kernel/scene_view.h"

namespace gloam {

struct ProfileStore {
  std::vector<ProfileView> profiles;
  std::vector<float> values;  ///< relative to each profile's most
};

ProfileStore make_profile_store(const std::vector<IesProfile>& profiles);

}  // namespace gloam
