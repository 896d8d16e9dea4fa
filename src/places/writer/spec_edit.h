#pragma once
// Functions of MuJoCo that change a spec, where memory may end.

#include <type_traits>

#include "base/abort_guard.h"

namespace gloam {

/// Calls a function that changes a spec: edit(mjs_setName, element, "box"). MuJoCo's C++ inside
/// cannot pass its exceptions to us: want of memory becomes std::bad_alloc, after which the spec
/// is to be thrown away. Not inside a guarded call (scene/files/mujoco_guard.h), which no
/// exception leaves.
template <class Result, class... Parameters>
Result edit(Result (*function)(Parameters...), std::type_identity_t<Parameters>... arguments) {
  if constexpr (std::is_void_v<Result>) {
    call_or_no_memory([&] { function(arguments...); });
  } else {
    Result result{};
    call_or_no_memory([&] { result = function(arguments...); });
    return result;
  }
}

}  // namespace gloam
