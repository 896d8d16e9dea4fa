#pragma once
// Lists that several parts of the module make.

#include <vector>

#include "core.h"
#include "gloam/topics.h"

namespace gloam::python {

nb::list topic_list(const std::vector<TopicInfo>& topics);

}  // namespace gloam::python
