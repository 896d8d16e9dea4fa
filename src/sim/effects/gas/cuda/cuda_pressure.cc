#include "sim/effects/gas/cuda/cuda_pressure.h"

namespace gloam::gas {
namespace {

constexpr int kPiece = 8192;  ///< cells of an enclosed space that one block adds up

}  // namespace

CudaPressure::CudaPressure(const Multigrid& multigrid, const Summing& summing, CardNumbers* host)
    : shape_(multigrid.finest().shape), summing_(summing), host_(host), multigrid_(multigrid) {
  const size_t size = size_t(shape_.size());
  for (auto* f : {&x_, &target_, &residual_, &z_, &p_, &ap_}) f->reserve(size);
  ones_.assign(std::vector<float>(size, 1.0f), summing.stream);
}

CudaPressure::~CudaPressure() {
  if (iteration_ != nullptr) cudaGraphExecDestroy(iteration_);
}

void CudaPressure::take_walls(const Openings& openings, const Multigrid& multigrid) {
  multigrid_.take(multigrid, summing_.stream);
  take_spaces(openings);
}

void CudaPressure::take_spaces(const Openings& openings) {
  enclosed_ = {};
  if (openings.enclosed == 0) return;
  // Order: by space, each in the order of cells; then in pieces.
  const size_t spaces = size_t(openings.enclosed);
  std::vector<int> first(spaces + 1, 0), cell, space, moving, piece_begin, space_begin;
  for (const int n : openings.space) {
    if (n > 0) ++first[size_t(n)];
  }
  for (size_t n = 1; n <= spaces; ++n) first[n] += first[n - 1];
  const size_t cells = size_t(first[spaces]);
  for (auto* list : {&cell, &space, &moving}) list->resize(cells);
  std::vector<int> next(first);
  std::vector<double> space_cells(spaces), space_moving(spaces);
  for (int c = 0; c < shape_.size(); ++c) {
    const int n = openings.space[size_t(c)] - 1;
    if (n < 0) continue;
    const size_t at = size_t(next[size_t(n)]++);
    cell[at] = c, space[at] = n, moving[at] = openings.moving_faces(c);
    space_cells[size_t(n)] += 1, space_moving[size_t(n)] += moving[at];
  }
  for (size_t n = 0; n < spaces; ++n) {
    space_begin.push_back(int(piece_begin.size()));
    for (int at = first[n]; at < first[n + 1]; at += kPiece) piece_begin.push_back(at);
  }
  const int pieces = int(piece_begin.size());
  space_begin.push_back(pieces);
  piece_begin.push_back(int(cells));

  const cudaStream_t stream = summing_.stream;
  cell_.assign(cell, stream), space_of_.assign(space, stream), moving_.assign(moving, stream);
  piece_begin_.assign(piece_begin, stream), space_begin_.assign(space_begin, stream);
  space_cells_.assign(space_cells, stream), space_moving_.assign(space_moving, stream);
  piece_sum_.reserve(size_t(pieces)), space_sum_.reserve(spaces);
  enclosed_ = {int(cells),         pieces,
               int(spaces),        cell_.get(),
               space_of_.get(),    moving_.get(),
               piece_begin_.get(), space_begin_.get(),
               space_cells_.get(), space_moving_.get(),
               piece_sum_.get(),   space_sum_.get()};
}

void CudaPressure::rescale(float factor) {
  scale(x_.get(), shape_.size(), factor, summing_.stream);
}

void CudaPressure::push(const Faces<float>& velocity, const float* share) {
  subtract_gradient(shape_, open(), velocity, share, x_.get(), summing_.stream);
}

void CudaPressure::look() {
  must(cudaMemcpyAsync(host_, summing_.numbers, sizeof *host_, cudaMemcpyDeviceToHost,
                       summing_.stream),
       "cannot copy from the GPU");
  must(cudaStreamSynchronize(summing_.stream), "a gas kernel failed");
}

Projection CudaPressure::project(const Faces<float>& velocity, const float* wanted, float voxel,
                                 float dt) {
  const Faces<const float> u = velocity.read();
  const cudaStream_t stream = summing_.stream;
  const System system{shape_,
                      u,
                      multigrid_.open_faces(),
                      multigrid_.finest().inverse,
                      wanted,
                      x_.get(),
                      target_.get(),
                      residual_.get(),
                      z_.get(),
                      p_.get(),
                      ap_.get()};
  set_targets(system, voxel / dt, stream);
  for (int pass = 0; pass < 2 && enclosed_.spaces > 0; ++pass) {
    balance_spaces(enclosed_, shape_, u, target_.get(), pass == 1, stream);
  }
  start_from_nothing(system, summing_);
  use_last_solution(system, summing_);
  look();
  Projection out;
  const double before = host_->before, goal = kTolerance * before;
  out.before = before / double(voxel);
  if (host_->norm > before) {  // the last solution is no help
    must(cudaMemsetAsync(x_.get(), 0, sizeof(float) * size_t(shape_.size()), stream),
         "cannot set GPU memory");
    start_from_nothing(system, summing_);
    host_->norm = before;
  }
  if (iteration_ == nullptr) {
    // Its launches know no velocity, and all else of it stays where it is.
    cudaGraph_t graph = nullptr;
    must(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal),
         "cannot create a CUDA graph");
    multigrid_.precondition(residual_.get(), z_.get(), stream);
    iterate(system, summing_);
    must(cudaMemcpyAsync(host_, summing_.numbers, sizeof *host_, cudaMemcpyDeviceToHost, stream),
         "cannot copy from the GPU");
    must(cudaStreamEndCapture(stream, &graph), "cannot create a CUDA graph");
    must(cudaGraphInstantiate(&iteration_, graph, 0), "cannot create a CUDA graph");
    must(cudaGraphDestroy(graph), "cannot create a CUDA graph");
  }
  while (host_->norm > goal && out.iterations < kMostIterations) {
    ++out.iterations;
    must(cudaGraphLaunch(iteration_, stream), "cannot launch a CUDA graph");
    must(cudaStreamSynchronize(stream), "a gas kernel failed");
    if (host_->positive == 0) break;  // nothing is left but rounding
    if (host_->norm > goal) continue;
    // The residual of conjugate gradients drifts from the true one: compute that, and go on if need
    // be.
    find_residual(system, summing_);
    look();
  }
  subtract_gradient(shape_, open(), velocity, ones_.get(), x_.get(), stream);
  // Error of the velocities themselves.
  find_error(system, summing_);
  look();
  out.after = host_->after / double(voxel);
  return out;
}

}  // namespace gloam::gas
