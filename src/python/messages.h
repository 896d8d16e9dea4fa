#pragma once
// Messages of topics: bytes, decoded and encoded by their types.

#include <cstdint>
#include <string>
#include <vector>

#include "core.h"

namespace gloam::python {

struct Message {
  std::string topic, type;
  int64_t step = 0;
  double time = 0, delivery = 0;  ///< [s]
  std::vector<uint8_t> data;      ///< CDR
};

void bind_messages(nb::module_& m);

}  // namespace gloam::python
