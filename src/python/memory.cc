#include "memory.h"

#include <mujoco/mjxmacro.h>
#include <mujoco/mujoco.h>

#include <map>
#include <type_traits>

#include "gloam/program.h"

namespace gloam::python {
namespace {

using Maker = nb::object (*)(const PhysicsMemory&, nb::handle owner);

template <class T>
nb::object field(const T* data, size_t rows, size_t columns, nb::handle owner) {
  using Number = std::conditional_t<std::is_same_v<T, bool>, uint8_t, T>;
  if constexpr (std::is_arithmetic_v<Number>) {
    const auto* numbers = reinterpret_cast<const Number*>(data);
    if (columns == 1) return array_over(numbers, {rows}, owner);
    return array_over(numbers, {rows, columns}, owner);
  } else {
    return nb::none();
  }
}

// An array that may not be written: the model is changed by Commands.
nb::object read_only(nb::object array) {
  if (!array.is_none()) array.attr("setflags")(nb::arg("write") = false);
  return array;
}

// By MuJoCo's own lists of fields (mjxmacro.h).
const std::map<std::string, Maker>& model_fields() {
  static const std::map<std::string, Maker> fields = [] {
    std::map<std::string, Maker> made;
#undef MJ_M
#define MJ_M(n) (memory.model->n)
#define X(type, name, nr, nc)                                                         \
  made[#name] = [](const PhysicsMemory& memory, nb::handle owner) {                   \
    return read_only(field(memory.model->name, static_cast<size_t>(memory.model->nr), \
                           static_cast<size_t>(nc), owner));                          \
  };
#define XNV X
    MJMODEL_POINTERS
#undef XNV
#undef X
    return made;
  }();
  return fields;
}

const std::map<std::string, Maker>& data_fields() {
  static const std::map<std::string, Maker> fields = [] {
    std::map<std::string, Maker> made;
#undef MJ_M
#define MJ_M(n) (memory.model->n)
#define X(type, name, nr, nc)                                              \
  made[#name] = [](const PhysicsMemory& memory, nb::handle owner) {        \
    return field(memory.data->name, static_cast<size_t>(memory.model->nr), \
                 static_cast<size_t>(nc), owner);                          \
  };
#define XNV X
    MJDATA_POINTERS
#undef XNV
#undef X
    return made;
  }();
  return fields;
}

/// Keeps the arrays of a model for its readers.
struct ModelKeeper {
  std::shared_ptr<ModelMirror> mirror;
};

uintptr_t lend_model(const ModelKeeper& keeper) {
  return reinterpret_cast<uintptr_t>(keeper.mirror->lend());
}

nb::object array_of(nb::handle self, const std::string& name) {
  const auto& memory = nb::cast<PhysicsMemory&>(self);
  for (const auto* fields : {&data_fields(), &model_fields()}) {
    const auto found = fields->find(name);
    if (found == fields->end()) continue;
    nb::object array = found->second(memory, self);
    if (!array.is_none()) return array;
  }
  std::vector<std::string> names;
  for (const auto* fields : {&data_fields(), &model_fields()})
    for (const auto& [field, maker] : *fields) names.push_back(field);
  raise("NotFoundError", "MuJoCo has no array '" + name + "'", suggest_name(name, names));
}

}  // namespace

DataMaker data_maker(nb::object make, std::shared_ptr<ModelMirrors> mirrors) {
  // Copies of the function are made and destroyed on threads without the interpreter.
  auto* kept = new nb::object(std::move(make));
  const std::shared_ptr<nb::object> shared(kept, [](nb::object* object) {
    const nb::gil_scoped_acquire acquired;
    delete object;
  });
  return [shared, mirrors = std::move(mirrors)](
             const std::shared_ptr<mjModel_>& model) -> std::shared_ptr<mjData_> {
    const nb::gil_scoped_acquire acquired;
    try {
      const nb::object made = (*shared)(nb::cast(ModelKeeper{mirrors->make(model)}));
      auto* data = reinterpret_cast<mjData_*>(nb::cast<uintptr_t>(made[0]));
      auto* owner = new nb::object(made[1]);
      return {data, [owner, model](mjData_*) {
                const nb::gil_scoped_acquire again;
                delete owner;
              }};
    } catch (nb::python_error& error) {
      error.discard_as_unraisable("gloam: memory of MuJoCo");
      return nullptr;
    }
  };
}

void bind_memory(nb::module_& m) {
  nb::class_<PhysicsMemory>(m, "Memory", "MuJoCo's memory of a simulation.")
      .def("array", &array_of, nb::arg("name"),
           "A field of mjData, or of mjModel (read only), as a live array without a copy.")
      .def_prop_ro("data_address",
                   [](const PhysicsMemory& p) { return reinterpret_cast<uintptr_t>(p.data.get()); })
      .def_prop_ro("time", [](const PhysicsMemory& p) { return double{p.data->time}; });
  nb::class_<ModelKeeper>(m, "ModelKeeper").def("lend", &lend_model);
  m.def("writable_model_arrays", &ModelMirror::writable);
  m.def("mujoco_version", [] { return std::string(mj_versionString()); });
}

}  // namespace gloam::python
