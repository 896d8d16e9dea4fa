#include "core.h"

#include <algorithm>
#include <condition_variable>
#include <thread>

#include "gloam/program.h"

namespace gloam::python {
namespace {

const char* class_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInput:
      return "InputError";
    case ErrorKind::kIo:
      return "IoError";
    case ErrorKind::kUsage:
      return "UsageError";
    case ErrorKind::kPartial:
      return "PartialError";
    case ErrorKind::kDiverged:
      return "DivergedError";
    case ErrorKind::kUnsupported:
      return "UnsupportedError";
    case ErrorKind::kInterrupted:
      return "StoppedError";
  }
  return "Error";
}

struct Deferred {
  std::mutex mutex;
  std::vector<std::function<void()>> streams, runs;
};

Deferred& deferred() {
  static auto* const list = new Deferred;  // outlives all threads
  return *list;
}

int destroy_on_main_thread(void*) {
  destroy_deferred();
  return 0;
}

[[noreturn]] void raise_class(const char* type, const Error& error) {
  const nb::gil_scoped_acquire acquired;  // the caller may have released it
  const nb::object cls = nb::module_::import_("gloam.errors").attr(type);
  const nb::object exception =
      cls(error.message, error.loc.file, error.loc.line, error.loc.column, error.hint);
  PyErr_SetObject(cls.ptr(), exception.ptr());
  throw nb::python_error();
}

}  // namespace

void destroy_when_safe(Kept kind, std::function<void()> destroy) {
  if (!CallbackScope::is_inside()) return destroy();
  {
    const std::lock_guard lock(deferred().mutex);
    (kind == Kept::kStream ? deferred().streams : deferred().runs).push_back(std::move(destroy));
  }
  Py_AddPendingCall(&destroy_on_main_thread, nullptr);
}

void destroy_deferred() {
  std::vector<std::function<void()>> streams, runs;
  {
    const std::lock_guard lock(deferred().mutex);
    streams.swap(deferred().streams);
    runs.swap(deferred().runs);
  }
  for (const auto& destroy : streams) destroy();
  for (const auto& destroy : runs) destroy();
}

void raise(const Error& error) { raise_class(class_of(error.kind), error); }

void raise(const char* type, const std::string& message, const std::string& hint) {
  raise_class(type, {ErrorKind::kUsage, message, {}, hint});
}

void wait_for(const std::function<void()>& job, const std::function<void()>& stop) {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::exception_ptr thrown;
  std::thread worker([&] {
    try {
      job();
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_one();
  });
  std::optional<nb::python_error> signal;
  const auto wait = [&](bool once) {
    const nb::gil_scoped_release released;
    std::unique_lock lock(mutex);
    if (once) return changed.wait_for(lock, kSignalPollPeriod, [&] { return done; });
    changed.wait(lock, [&] { return done; });
    return true;
  };
  while (!wait(true)) {
    if (PyErr_CheckSignals() == 0) continue;
    signal.emplace();
    stop();
    wait(false);
    break;
  }
  worker.join();
  if (signal) throw std::move(*signal);
  if (thrown) std::rethrow_exception(thrown);
}

bool wait_patiently(const std::function<bool()>& is_done, std::chrono::seconds patience) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kSleepPeriod{1};
  for (const auto end = Clock::now() + patience; !is_done();) {
    if (Clock::now() > end) return false;
    {
      const nb::gil_scoped_release released;
      std::this_thread::sleep_for(kSleepPeriod);
    }
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  return true;
}

ProgressCallback PythonProgress::callback() {
  return [this](const Progress& progress) { return !stopped_ && tell(progress) && !stopped_; };
}

bool PythonProgress::tell(const Progress& progress) {
  if (callable_.is_none()) return true;
  const nb::gil_scoped_acquire acquired;
  try {
    const nb::object goes_on =
        callable_(progress.what, progress.done, progress.seconds, progress.left);
    return goes_on.is_none() || nb::cast<bool>(goes_on);
  } catch (nb::python_error& error) {
    error_.keep(std::move(error));
    return false;
  }
}

void Keywords::refuse_others() const {
  for (const auto [key, value] : given_) {
    const auto name = nb::cast<std::string>(key);
    if (std::ranges::find(known_, name) == known_.end())
      raise("UsageError", "there is no option '" + name + "' here", suggest_name(name, known_));
  }
}

void FirstError::keep(nb::python_error&& error) {
  const std::lock_guard lock(mutex_);
  if (error_ == nullptr) error_ = std::make_unique<nb::python_error>(std::move(error));
}

void FirstError::rethrow() {
  std::unique_ptr<nb::python_error> error;
  {
    const std::lock_guard lock(mutex_);
    error.swap(error_);
  }
  if (error != nullptr) throw std::move(*error);
}

int FirstError::traverse(visitproc visit, void* arg) const {
  if (error_ != nullptr) Py_VISIT(error_->value().ptr());
  return 0;
}

void FirstError::clear() {
  std::unique_ptr<nb::python_error> error;
  const std::lock_guard lock(mutex_);
  error.swap(error_);
}

std::vector<double> doubles(nb::handle numbers) {
  nb::ndarray<const double, nb::c_contig, nb::device::cpu> array;
  if (nb::try_cast(numbers, array, true)) return {array.data(), array.data() + array.size()};
  std::vector<double> list;
  if (nb::try_cast(numbers, list)) return list;
  double one;
  if (nb::try_cast(numbers, one)) return {one};
  throw nb::type_error("expected numbers: an array, a list or a number");
}

std::vector<double> doubles(nb::handle numbers, size_t count, const char* what) {
  std::vector<double> list = doubles(numbers);
  if (list.size() != count) {
    const std::string text = std::string(what) + ": expected " + std::to_string(count) +
                             " numbers, got " + std::to_string(list.size());
    throw nb::value_error(text.c_str());
  }
  return list;
}

Vec3 vec3(nb::handle numbers, const char* what) {
  const std::vector<double> v = doubles(numbers, 3, what);
  return {v[0], v[1], v[2]};
}

Pose pose(nb::handle value) {
  const bool has_parts = nb::hasattr(value, "p") && nb::hasattr(value, "q");
  const nb::object p = has_parts ? nb::object(value.attr("p")) : nb::object(value[0]);
  const nb::object q = has_parts ? nb::object(value.attr("q")) : nb::object(value[1]);
  const std::vector<double> w = doubles(q, 4, "a quaternion (w, x, y, z)");
  return {vec3(p, "a position"), {w[0], w[1], w[2], w[3]}};
}

nb::tuple pose_tuple(const Pose& X) {
  return nb::make_tuple(new_array<double>({X.p.x, X.p.y, X.p.z}, {3}),
                        new_array<double>({X.q.w, X.q.x, X.q.y, X.q.z}, {4}));
}

}  // namespace gloam::python
