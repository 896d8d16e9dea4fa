#include "sim/effects/gas/cuda/cuda_multigrid.h"

#include "sim/effects/gas/kernel/cycle.h"

namespace gloam::gas {
namespace {

constexpr int kSmallValues = 50'000;  ///< floats that a block has room for: 200 of 227 KiB

/// Records the steps of a cycle.
struct Recorder {
  std::vector<CycleWork>* works;
  void add(CycleStep step, int level) { works->push_back({step, uint8_t(level), 0}); }
  void begin(int level) { add(CycleStep::kBegin, level); }
  void forth(int level, int n) { add(n == 0 ? CycleStep::kForth0 : CycleStep::kForth1, level); }
  void back(int level, int n) { add(n == 0 ? CycleStep::kBack0 : CycleStep::kBack1, level); }
  void restrict_residual(int level) { add(CycleStep::kRestrict, level); }
  void prolong(int level) { add(CycleStep::kProlong, level); }
};

}  // namespace

CudaMultigrid::CudaMultigrid(const Multigrid& multigrid) : levels_(size_t(multigrid.levels())) {
  for (size_t l = 0; l < levels_.size(); ++l) {
    CudaLevel& level = levels_[l];
    level.shape = multigrid.view(l).shape;
    const size_t size = size_t(level.shape.size());
    for (auto& w : level.weight) w.reserve(size);
    for (auto* f : {&level.inverse, &level.scratch}) f->reserve(size);
    if (l == 0) {
      open_.reserve(size);
      continue;  // the caller's x and b
    }
    for (auto* f : {&level.x, &level.b}) f->reserve(size);
    for (int a = 0; a < 3; ++a) {
      level.start[a].reserve(size_t(level.shape.n(a)) + 1);
      level.parent[a].reserve(size_t(levels_[l - 1].shape.n(a)) + 2);
    }
  }
  Recorder recorder{&works_};
  run_cycle(recorder, 0, multigrid.levels(), true);
  for (size_t n = works_.size(); n-- > 0;) {
    CycleWork& work = works_[n];
    if (work.step == CycleStep::kRestrict || work.step == CycleStep::kProlong) continue;
    const bool goes_on = n + 1 < works_.size() && works_[n + 1].level == work.level;
    work.run = uint8_t(1 + (goes_on ? works_[n + 1].run : 0));
  }
  works_on_card_.assign(works_, nullptr);

  // The small levels: as many of the last as one block has memory for.
  small_.first = int(levels_.size());
  for (int l = int(levels_.size()) - 1; l > 0; --l) {
    const Shape& s = levels_[size_t(l)].shape;
    const int values = small_.values + SmallLevels::kArrays * s.size();
    if (s.nx * s.ny * s.nz > SmallLevels::kMostCells || values > kSmallValues) break;
    if (int(levels_.size()) - l > SmallLevels::kMaxLevels) break;
    small_.first = l, small_.values = values;
  }
  int place = 0;
  for (size_t l = size_t(small_.first); l < levels_.size(); ++l) {
    const CudaLevel& level = levels_[l];
    SmallLevels::Level& to = small_.levels[small_.count++];
    to.shape = level.shape;
    to.inverse = level.inverse.get();
    for (int a = 0; a < 3; ++a) {
      to.weight[a] = level.weight[a].get();
      to.start[a] = level.start[a].get();
      to.parent[a] = level.parent[a].get();
    }
    to.place = place;
    place += SmallLevels::kArrays * level.shape.size();
  }
  if (small_.count == 0) return;
  small_.works = works_on_card_.get();
  small_.b = levels_[size_t(small_.first)].b.get();
  small_.x = levels_[size_t(small_.first)].x.get();
  allow_small_levels(small_);
}

void CudaMultigrid::take(const Multigrid& multigrid, cudaStream_t stream) {
  const Shape& s = levels_[0].shape;
  open_.assign({multigrid.open_faces(), size_t(s.size())}, stream);
  spread_open_faces(
      s, open_.get(),
      {levels_[0].weight[0].get(), levels_[0].weight[1].get(), levels_[0].weight[2].get()},
      levels_[0].inverse.get(), stream);
  std::vector<int> parent;
  for (size_t l = 1; l < levels_.size(); ++l) {
    CudaLevel& level = levels_[l];
    const PoissonView v = multigrid.view(l);
    const size_t size = size_t(level.shape.size());
    for (int a = 0; a < 3; ++a) {
      level.weight[a].assign({v.weight[a], size}, stream);
      const std::vector<int>& start = multigrid.start(l, a);
      level.start[a].assign(start, stream);
      const int cells = int(start.size()) - 1;
      parent.assign(1, -1);
      for (int i = 0; i < cells; ++i) parent.resize(size_t(start[size_t(i) + 1]) + 1, i);
      parent.push_back(cells);
      level.parent[a].assign(parent, stream);
    }
    level.inverse.assign({v.inverse, size}, stream);
  }
}

void CudaMultigrid::precondition(const float* r, float* z, cudaStream_t stream) const {
  for (size_t n = 0; n < works_.size();) {
    size_t end = n;
    while (end < works_.size() && works_[end].level >= small_.first) ++end;
    if (end > n) {
      work_on_small_levels(small_, int(n), int(end), stream);
      n = end;
      continue;
    }
    // Smoothing follows at once, on the way down and on the way up.
    const CycleStep step = works_[n].step;
    launch_step(works_[n], r, z, stream);
    n += step == CycleStep::kBegin || step == CycleStep::kProlong ? 2 : 1;
  }
}

void CudaMultigrid::launch_step(CycleWork work, const float* r, float* z,
                                cudaStream_t stream) const {
  const size_t l = work.level;
  const CudaLevel& level = levels_[l];
  const PoissonView v = level.view();
  const uint8_t* open = l == 0 ? open_.get() : nullptr;
  const float* b = l == 0 ? r : level.b.get();
  float *x = l == 0 ? z : level.x.get(), *t = level.scratch.get();
  switch (work.step) {
    case CycleStep::kBegin:
      smooth_from_nothing(v, open, b, x, {{kSmooth[0], kSmooth[1]}}, stream);
      break;
    case CycleStep::kForth0:
      smooth(v, open, b, x, t, kSmooth[0], stream);
      break;
    case CycleStep::kForth1:
      smooth(v, open, b, x, t, kSmooth[1], stream);
      break;
    case CycleStep::kBack0:
      smooth(v, open, b, t, x, kSmooth[0], stream);
      break;
    case CycleStep::kBack1:
      smooth(v, open, b, t, x, kSmooth[1], stream);
      break;
    case CycleStep::kRestrict: {
      const CudaLevel& next = levels_[l + 1];
      const Axes start{{next.start[0].get(), next.start[1].get(), next.start[2].get()}};
      restrict_to(v, open, x, b, next.shape, start, next.b.get(), stream);
      break;
    }
    case CycleStep::kProlong: {
      const CudaLevel& next = levels_[l + 1];
      const Axes parent{{next.parent[0].get(), next.parent[1].get(), next.parent[2].get()}};
      prolong_and_smooth(v, open, b, x, next.shape, parent, next.x.get(), t, kSmooth[1], stream);
      break;
    }
  }
}

}  // namespace gloam::gas
