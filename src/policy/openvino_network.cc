#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "base/files.h"
#include "policy/network.h"
#include "policy/onnx/onnx_file.h"
#include "policy/onnx/protobuf.h"
#include "policy/openvino_api.h"
#include "policy/scratch_folder.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr int64_t kF32 = 1;               // onnx.TensorProto.DataType
constexpr uint64_t kBytesPerElement = 8;  // of results, the largest that networks use

/// A C object with its release function.
using OvObject = std::shared_ptr<void>;

Error ov_error(const OpenvinoApi& ov, const fs::path& path) {
  // The last line has the cause; those before it have places in OpenVINO's source.
  std::string text = ov.last_error(), line;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (text.find_first_not_of(" \t\r", begin) < end) line = text.substr(begin, end - begin);
    begin = end + 1;
  }
  return {ErrorKind::kInput,
          fmt::format("OpenVINO cannot read the network: {:.300}", line),
          {path.string(), 0, 0}};
}

/// The sizes of an input for one observation.
Result<std::vector<int64_t>> shape_of(const OnnxPort& port, const fs::path& path) {
  std::vector<int64_t> dims = port.dims;
  if (!dims.empty() && dims[0] < 0) dims[0] = 1;
  const SourceLoc loc{path.string(), 0, 0};
  if (port.element_type != kF32)
    return Error{ErrorKind::kUnsupported,
                 fmt::format("the network's input '{:.80}' has another type than f32", port.name),
                 loc, "export the policy with inputs of type float32"};
  if (std::ranges::any_of(dims, [](int64_t size) { return size < 0; }))
    return Error{ErrorKind::kInput,
                 fmt::format("the network's input '{:.80}' has an open size", port.name), loc,
                 "export the policy for one observation: all sizes except the batch must be fixed"};
  return dims;
}

/// Gives the inputs of a model their sizes for one observation.
Status fix_inputs(const OpenvinoApi& ov, const OnnxFile& file, const void* model) {
  for (const OnnxPort& input : file.inputs) {
    GLOAM_TRY(const std::vector<int64_t> dims, shape_of(input, file.path));
    OvPartialShape shape;
    if (ov.shape_create(std::ssize(dims), dims.data(), &shape) != 0) return ov_error(ov, file.path);
    const int status = ov.model_reshape_input(model, input.name.c_str(), shape);
    ov.shape_free(&shape);
    if (status != 0) return ov_error(ov, file.path);
  }
  return {};
}

Result<OvObject> read_model(const OpenvinoApi& ov, const OnnxFile& file, const std::string& bytes) {
  void* model = nullptr;
  int status = 0;
  if (file.external.empty()) {
    status = ov.core_read_model_bytes(ov.core, bytes.data(), bytes.size(), nullptr, &model);
  } else {  // OpenVINO finds weights in other files by the network's own path
    GLOAM_TRY(const ScratchFolder folder, ScratchFolder::create());
    GLOAM_TRY_STATUS(write_text_file_atomic(folder.path() / "network.onnx", bytes));
    for (const std::string& name : file.external) {
      const fs::path copy = folder.path() / name;
      GLOAM_TRY_STATUS(make_folder(copy.parent_path()));
      std::error_code code;
      if (!fs::copy_file(file.path.parent_path() / name, copy, code))
        return Error{ErrorKind::kIo,
                     fmt::format("cannot copy '{:.80}': {}", name, code.message()),
                     {file.path.string(), 0, 0}};
    }
    const std::string path = (folder.path() / "network.onnx").string();
    status = ov.core_read_model(ov.core, path.c_str(), nullptr, &model);
  }
  if (status != 0) return ov_error(ov, file.path);
  OvObject object(model, ov.model_free);
  GLOAM_TRY_STATUS(fix_inputs(ov, file, model));
  return object;
}

/// Numbers of an output of a model; -1 if its size depends on values.
int64_t count_of(const OpenvinoApi& ov, const void* port) {
  OvPartialShape shape;
  if (ov.port_partial_shape(port, &shape) != 0) return -1;
  int64_t count = shape.rank.min == shape.rank.max ? 1 : -1;
  for (int64_t i = 0; count > 0 && i < shape.rank.max; ++i) {
    const OvDimension dim = shape.dims[i];
    if (dim.min != dim.max || dim.min < 0)
      count = -1;
    else
      count =
          dim.min != 0 && count > (int64_t{1} << 40) / dim.min ? int64_t{1} << 40 : count * dim.min;
  }
  ov.shape_free(&shape);
  return count;
}

/// Checks the sizes of all results before any is computed: an Expand makes a constant of two
/// numbers a million times as large. A copy of the file that declares every result as an output of
/// the graph lets OpenVINO infer their sizes. (Messages in the wire format merge when they are
/// concatenated.)
Status check_results(const OpenvinoApi& ov, const OnnxFile& file, const std::string& bytes) {
  std::string outputs;
  for (const std::string& name : file.results) {
    const bool known = std::ranges::any_of(
        file.outputs, [&](const OnnxPort& output) { return output.name == name; });
    if (!known) outputs += wire_field(12, wire_field(1, name));  // GraphProto.output, .name
  }
  GLOAM_TRY(const OvObject model, read_model(ov, file, bytes + wire_field(7, outputs)));
  size_t count = 0;
  uint64_t total = 0;
  if (ov.model_outputs_size(model.get(), &count) != 0) return ov_error(ov, file.path);
  for (size_t i = 0; i < count; ++i) {
    void* raw = nullptr;
    if (ov.model_output(model.get(), i, &raw) != 0) return ov_error(ov, file.path);
    const OvObject port(raw, ov.port_free);
    char* text = nullptr;
    const std::string name = ov.port_any_name(raw, &text) == 0 ? std::string(text) : "";
    if (text != nullptr) ov.text_free(text);
    const int64_t numbers = count_of(ov, raw);
    if (numbers < 0)
      return Error{ErrorKind::kInput,
                   fmt::format("result '{:.80}' has no fixed size", name),
                   {file.path.string(), 0, 0},
                   "export the policy for one observation: all sizes except the batch must be "
                   "fixed"};
    total += static_cast<uint64_t>(numbers) * kBytesPerElement;
    if (total > kLargestOnnxTensors)
      return Error{ErrorKind::kInput,
                   fmt::format("the network's operations would take over {} MiB, '{:.80}' has {} "
                               "numbers",
                               kLargestOnnxTensors >> 20, name, numbers),
                   {file.path.string(), 0, 0}};
  }
  return {};
}

class OpenvinoNetwork final : public Network {
 public:
  static Result<std::unique_ptr<Network>> create(const OpenvinoApi& ov, OvObject compiled,
                                                 const OnnxFile& file) {
    auto made = std::make_unique<OpenvinoNetwork>();
    made->ov_ = &ov;
    made->compiled_ = std::move(compiled);
    for (const OnnxPort& port : file.inputs) made->inputs_.push_back({port.name, 0});
    for (const OnnxPort& port : file.outputs) made->outputs_.push_back({port.name, 0});
    if (!made->open()) return ov_error(ov, file.path);
    for (const OnnxPort& port : file.outputs)
      if (port.element_type != kF32)
        return Error{
            ErrorKind::kUnsupported,
            fmt::format("the network's output '{:.80}' has another type than f32", port.name),
            {file.path.string(), 0, 0}};
    return std::unique_ptr<Network>(std::move(made));
  }

  std::span<float> input(size_t i) override { return in_[i]; }
  std::span<const float> output(size_t i) const override { return out_[i]; }
  bool run() override { return ov_->request_infer(request_.get()) == 0; }
  std::unique_ptr<Network> share() const override {
    auto copy = std::make_unique<OpenvinoNetwork>();
    copy->ov_ = ov_;
    copy->compiled_ = compiled_;
    copy->inputs_ = inputs_;
    copy->outputs_ = outputs_;
    return copy->open() ? std::move(copy) : nullptr;
  }

 private:
  /// Creates the request and finds its buffers. Code is generated in the first run.
  bool open() {
    void* request = nullptr;
    if (ov_->create_request(compiled_.get(), &request) != 0) return false;
    request_ = OvObject(request, ov_->request_free);
    for (NetworkPort& port : inputs_) {
      in_.push_back(buffer(&port));
      if (in_.back().data() == nullptr) return false;
      std::ranges::fill(in_.back(), 0.0f);
    }
    if (!run()) return false;
    for (NetworkPort& port : outputs_) {
      out_.push_back(buffer(&port));
      if (out_.back().data() == nullptr) return false;
    }
    return true;
  }

  std::span<float> buffer(NetworkPort* port) {
    void* raw = nullptr;
    if (ov_->request_tensor(request_.get(), port->name.c_str(), &raw) != 0) return {};
    tensors_.emplace_back(raw, ov_->tensor_free);
    void* data = nullptr;
    size_t count = 0, bytes = 0;
    if (ov_->tensor_data(raw, &data) != 0 || ov_->tensor_size(raw, &count) != 0 ||
        ov_->tensor_byte_size(raw, &bytes) != 0 || bytes != count * sizeof(float))
      return {};
    port->size = count;
    return {static_cast<float*>(data), count};
  }

  const OpenvinoApi* ov_ = nullptr;
  OvObject compiled_, request_;
  std::vector<OvObject> tensors_;
  std::vector<std::span<float>> in_, out_;
};

}  // namespace

Result<LoadedNetwork> load_onnx_network(const fs::path& path) {
  static std::mutex one_at_a_time;  // the library's last error belongs to the process
  GLOAM_TRY(const std::vector<uint8_t> read, read_file(path, kLargestOnnxFile));
  GLOAM_TRY(OnnxFile file, parse_onnx(read, path));
  const std::string bytes(read.begin(), read.end());
  GLOAM_TRY(const OpenvinoApi* ov, openvino());
  const std::lock_guard lock(one_at_a_time);
  GLOAM_TRY_STATUS(check_results(*ov, file, bytes));
  GLOAM_TRY(const OvObject model, read_model(*ov, file, bytes));
  void* compiled = nullptr;
  constexpr size_t kWords = 10;
  if (ov->core_compile_model(ov->core, model.get(), "CPU", kWords, &compiled,
                             "INFERENCE_PRECISION_HINT", "f32", "EXECUTION_MODE_HINT", "ACCURACY",
                             "INFERENCE_NUM_THREADS", "1", "NUM_STREAMS", "1", "ENABLE_CPU_PINNING",
                             "NO") != 0)
    return ov_error(*ov, path);
  GLOAM_TRY(auto network,
            OpenvinoNetwork::create(*ov, OvObject(compiled, ov->compiled_free), file));
  return LoadedNetwork{std::move(network), std::move(file.metadata)};
}

}  // namespace gloam
