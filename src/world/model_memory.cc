#include "world/model_memory.h"

#include <new>

#include "scene/files/mujoco_guard.h"

namespace gloam {

DataPtr make_data(const mjModel& model) {
  mjData* data = nullptr;
  if (!try_mujoco([&] { data = mj_makeData(&model); }) || data == nullptr) throw std::bad_alloc();
  return DataPtr(data);
}

ModelPtr copy_model(const mjModel& model) {
  mjModel* copy = nullptr;
  if (!try_mujoco([&] { copy = mj_copyModel(nullptr, &model); }) || copy == nullptr)
    throw std::bad_alloc();
  return ModelPtr(copy);
}

}  // namespace gloam
