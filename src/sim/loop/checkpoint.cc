#include "sim/loop/checkpoint.h"

namespace gloam {

int64_t Checkpoint::step() const { return data_->record.step; }
double Checkpoint::time() const { return data_->time; }
uint64_t Checkpoint::seed() const { return data_->record.seed; }
uint64_t Checkpoint::hash() const { return data_->record.hash; }
World Checkpoint::world() const { return World(data_->record.chapters.back().world); }
const std::vector<Command>& Checkpoint::commands() const { return data_->record.commands; }
bool Checkpoint::is_copied() const { return data_->copy != nullptr; }

}  // namespace gloam
