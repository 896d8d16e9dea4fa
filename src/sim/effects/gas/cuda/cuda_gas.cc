#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/effects/gas/cuda/cuda_gas.h"
#include "sim/effects/gas/cuda/cuda_momentum.h"
#include "sim/effects/gas/cuda/cuda_pressure.h"
#include "sim/effects/gas/cuda/cuda_transport.h"
#include "sim/effects/gas/cuda/gas_kernels.h"

namespace gloam::gas {
namespace {

/// Values of a cell that goes to the host: scalars, heat release.
constexpr int kCellValues = kScalars + 1;
/// Floats in the card's memory for each cell and ghost, about.
constexpr uint64_t kFloatsPerCell = 45;

class DeviceGas final : public CudaGas {
 public:
  DeviceGas(std::string name, const GasGrid& grid, const Openings& openings,
            const Multigrid& multigrid, const HostFields& fields)
      : name_(std::move(name)),
        grid_(grid),
        shape_(openings.shape),
        openings_(openings),
        host_multigrid_(multigrid),
        host_(fields),
        stream_(make_stream()),
        slabs_(size_t(4 * openings.shape.nz)),
        numbers_(1),
        summing_{slabs_.get(), numbers_.get(), stream_},
        pressure_(multigrid, summing_, look_.reserve(1)),
        momentum_(openings, stream_),
        transport_(openings.shape, summing_),
        heated_(size_t(openings.shape.size())),
        burning_(size_t(openings.shape.size())) {
    for (auto& f : velocity_) f.reserve(size_t(shape_.size()));
    for (auto& f : scalars_) f.reserve(size_t(shape_.size()));
    for (Field* f : host_) {
      must(cudaHostRegister(f->data(), f->size() * sizeof(float), cudaHostRegisterDefault),
           "cannot pin memory");
    }
    must(cudaDeviceSynchronize(), "the GPU does not respond");
  }
  ~DeviceGas() override {
    cudaStreamSynchronize(stream_);
    for (Field* f : host_) cudaHostUnregister(f->data());
    cudaStreamDestroy(stream_);
  }

  std::string device_name() const override { return name_; }

  void take_walls(const GasWalls& walls) override {
    pressure_.take_walls(openings_, host_multigrid_);
    momentum_.take_walls(openings_);
    const Faces<float> u = faces();
    stop_closed_faces(shape_, pressure_.open(), u, stream_);
    for (int a = 0; a < 3; ++a) {
      moving_at_.clear(), moving_.clear();
      const Shape faces = shape_.faces(a);
      const uint8_t* moves = openings_.moving[a].data();
      for (int k = 0; k < faces.nz; ++k) {
        for (int j = 0; j < faces.ny; ++j) {
          const int begin = faces.at(0, j, k);
          uint8_t any = 0;
          for (int c = begin; c < begin + faces.nx; ++c) any |= moves[c];
          if (any == 0) continue;
          const float* own = walls.velocity[a].data() + walls.face(a, 0, j, k);
          for (int i = 0; i < faces.nx; ++i) {
            if (moves[begin + i]) moving_at_.push_back(begin + i), moving_.push_back(own[i]);
          }
        }
      }
      indices_.assign(moving_at_, stream_);
      values_.assign(moving_, stream_);
      set_values(u[a], indices_.get(), values_.get(), int(moving_.size()), stream_);
    }
    finish();
  }

  void upload(uint32_t fields) override { copy(fields, cudaMemcpyHostToDevice); }
  void download(uint32_t fields) override { copy(fields, cudaMemcpyDeviceToHost); }

  void download_cells(std::span<const int> cells) override {
    if (cells.empty()) return;
    const size_t count = cells.size() * kCellValues;
    indices_.assign(cells, stream_);
    values_.reserve(count);
    copy_cells(cell_values(), indices_.get(), int(cells.size()), values_.get(), false, stream_);
    cell_list_.resize(count);
    must(cudaMemcpyAsync(cell_list_.data(), values_.get(), count * sizeof(float),
                         cudaMemcpyDeviceToHost, stream_),
         "cannot copy from the GPU");
    finish();
    for (size_t f = 0; f < kCellValues; ++f) {
      for (size_t n = 0; n < cells.size(); ++n) {
        (*host_[3 + f])[size_t(cells[n])] = cell_list_[f * cells.size() + n];
      }
    }
  }

  void upload_cells(std::span<const int> cells) override {
    if (cells.empty()) return;
    cell_list_.resize(cells.size() * kCellValues);
    for (size_t f = 0; f < kCellValues; ++f) {
      for (size_t n = 0; n < cells.size(); ++n) {
        cell_list_[f * cells.size() + n] = (*host_[3 + f])[size_t(cells[n])];
      }
    }
    indices_.assign(cells, stream_);
    values_.assign(cell_list_, stream_);
    copy_cells(cell_values(), indices_.get(), int(cells.size()), values_.get(), true, stream_);
    finish();
  }

  float max_speed() override {
    find_speed(shape_, faces().read(), summing_);
    return std::sqrt(most());
  }

  Outcome substep(const Substep& step, std::span<const Gift> gifts, std::span<const int> cells,
                  const Additions& additions, uint64_t* parity) override {
    const Faces<float> u = faces();
    const Faces<const float> open = pressure_.open();
    const ScalarFields scalars = scalar_fields();
    const float voxel = grid_.voxel, dt = step.dt;
    gift_cells_.assign(cells, stream_);
    indices_.assign(additions.at, stream_);
    values_.assign(additions.values, stream_);
    // Additions to fields [from, to). One after the other: two may add to the same face.
    const auto add = [&](int from, int to) {
      const int* at = indices_.get();
      const float* values = values_.get();
      for (const Addition& a : additions.list) {
        if (a.field >= from && a.field < to)
          add_values(field(a.field), at, values, a.count, stream_);
        at += a.count, values += a.count;
      }
    };
    const auto for_gifts = [&](auto&& f) {
      const int* at = gift_cells_.get();
      for (const Gift& gift : gifts) {
        f(gift, at);
        at += gift.cells;
      }
    };
    must(cudaMemsetAsync(heated_.get(), 0, sizeof(float) * size_t(shape_.size()), stream_),
         "cannot set GPU memory");
    must(cudaMemsetAsync(numbers_.get(), 0, sizeof(CardNumbers), stream_), "cannot set GPU memory");
    for_gifts([&](const Gift& g, const int* at) { give(g, at, scalars, heated_.get(), stream_); });
    add(3, 3 + kScalars);
    react_all(shape_, step.rates, step.power, scalars, heated_.get(), burning_.get(), summing_);
    if (step.rescale != 1.0f) pressure_.rescale(step.rescale);

    const auto lift_half = [&] {
      momentum_.lift(open, faces(), scalars.of[kHeat], scalars.of[kSmoke], step.ambient_density,
                     0.5f * dt, uint32_t(*parity));
    };
    momentum_.trace(open, u.read(), voxel, dt);
    pressure_.push(u, momentum_.smoothness());
    lift_half();
    momentum_.carry(open, velocity_, voxel, dt, step.wind);
    const Faces<float> carried = faces();
    lift_half();
    if (step.vorticity > 0) momentum_.confine(open, carried, step.vorticity, dt);
    for_gifts([&](const Gift& g, const int* at) {
      if (g.blows) blow(g, at, shape_, open, carried, stream_);
    });
    add(0, 3);
    Outcome out;
    out.projection = pressure_.project(carried, heated_.get(), voxel, dt);

    transport_.set_courant(open, carried.read(), dt / voxel);
    out.transport_substeps = std::max(1, int(std::ceil(most() / kMostOutflow)));
    if (out.transport_substeps > 1) {
      const float n = float(out.transport_substeps);
      transport_.set_courant(open, carried.read(), dt / (voxel * n));
    }
    for (int n = 0; n < out.transport_substeps; ++n) {
      transport_.carry(open, scalars, (*parity)++);
    }
    look();
    std::copy(look_.get()->reaction, look_.get()->reaction + 4, out.reaction);
    std::copy(look_.get()->escaped, look_.get()->escaped + kScalars, out.escaped);
    return out;
  }

 private:
  static cudaStream_t make_stream() {
    cudaStream_t stream = nullptr;
    must(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "cannot create a CUDA stream");
    return stream;
  }

  Faces<float> faces() const {
    return {velocity_[0].get(), velocity_[1].get(), velocity_[2].get()};
  }
  ScalarFields scalar_fields() const {
    ScalarFields out;
    for (int f = 0; f < kScalars; ++f) out.of[f] = scalars_[f].get();
    return out;
  }
  CellValues cell_values() const {
    CellValues out;
    for (int f = 0; f < kScalars; ++f) out.of[f] = scalars_[f].get();
    out.of[kScalars] = burning_.get();
    return out;
  }
  float* field(int n) {
    if (n < 3) return velocity_[n].get();
    if (n < 3 + kScalars) return scalars_[n - 3].get();
    return n == 3 + kScalars ? burning_.get() : pressure_.solution();
  }

  void copy(uint32_t fields, cudaMemcpyKind way) {
    for (int n = 0; n < kFields; ++n) {
      if ((fields & 1u << n) == 0) continue;
      Field& host = *host_[size_t(n)];
      const bool up = way == cudaMemcpyHostToDevice;
      void* const to = up ? field(n) : host.data();
      const void* const from = up ? host.data() : field(n);
      must(cudaMemcpyAsync(to, from, host.size() * sizeof(float), way, stream_),
           "cannot copy a field of the gas");
    }
    finish();
  }

  void finish() {
    must(cudaGetLastError(), "cannot launch a gas kernel");
    must(cudaStreamSynchronize(stream_), "a gas kernel failed");
  }
  void look() {
    must(cudaMemcpyAsync(look_.get(), numbers_.get(), sizeof(CardNumbers), cudaMemcpyDeviceToHost,
                         stream_),
         "cannot copy from the GPU");
    finish();
  }
  /// Result of find_most().
  float most() {
    look();
    return std::bit_cast<float>(look_.get()->most);
  }

  std::string name_;
  GasGrid grid_;
  Shape shape_;
  const Openings& openings_;
  const Multigrid& host_multigrid_;
  HostFields host_;
  cudaStream_t stream_;
  DeviceArray<double> slabs_;
  DeviceArray<CardNumbers> numbers_;
  PinnedArray<CardNumbers> look_;
  Summing summing_;
  CudaPressure pressure_;
  CudaMomentum momentum_;
  CudaTransport transport_;
  DeviceArray<float> velocity_[3], scalars_[kScalars], heated_, burning_;
  // Lists on their way.
  DeviceArray<int> gift_cells_, indices_;
  DeviceArray<float> values_;
  std::vector<int> moving_at_;
  std::vector<float> moving_, cell_list_;
};

}  // namespace

Result<std::unique_ptr<CudaGas>> CudaGas::make(const GasGrid& grid, const Openings& openings,
                                               const Multigrid& multigrid,
                                               const HostFields& fields) {
  const auto none = [](std::string why) {
    return Error{ErrorKind::kUnsupported, std::move(why), {}, "simulate the gas on the CPU"};
  };
  int driver = 0, count = 0;
  if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) {
    return none("no NVIDIA GPU for gases: the driver is not installed");
  }
  if (const cudaError_t error = cudaGetDeviceCount(&count); error != cudaSuccess || count == 0) {
    return none(fmt::format("no NVIDIA GPU for gases: {}",
                            error != cudaSuccess ? cudaGetErrorString(error) : "none was found"));
  }
  cudaDeviceProp properties;
  if (const cudaError_t error = cudaGetDeviceProperties(&properties, 0); error != cudaSuccess) {
    return none(fmt::format("the NVIDIA GPU does not respond: {}", cudaGetErrorString(error)));
  }
  if (properties.major < 9) {
    return none(fmt::format("{} has compute capability {}.{}, but gases require 9.0",
                            properties.name, properties.major, properties.minor));
  }
  size_t free = 0, all = 0;
  const uint64_t need = uint64_t(openings.shape.size()) * kFloatsPerCell * sizeof(float);
  if (cudaMemGetInfo(&free, &all) != cudaSuccess || need > free) {
    return none(
        fmt::format("a gas of {} cells needs {} MiB of GPU memory, but only {} MiB are free",
                    grid.cells(), need >> 20, free >> 20));
  }
  return std::unique_ptr<CudaGas>(
      new DeviceGas(properties.name, grid, openings, multigrid, fields));
}

}  // namespace gloam::gas
