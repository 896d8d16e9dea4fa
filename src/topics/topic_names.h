#pragma once
// Unique names for topics: elements of a model may have any names, even those of the simulation's
// own topics.

#include <vector>

#include "gloam/result.h"
#include "topics/topic_table.h"

namespace gloam {

/// Renames topics of elements whose names are taken: by the simulation's own topics, by topics that
/// ROS 2 itself has, or by an element before. All topics of an element are renamed alike,
/// "/front/image_raw" to "/front_2/image_raw". Adds a note for each of them.
void make_names_unique(TopicTable* table, std::vector<Error>* notes);

}  // namespace gloam
