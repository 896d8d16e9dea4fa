#pragma once
// Core of the Python module: errors as exceptions, calls that wait, arrays without copies.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "gloam/world.h"

namespace nb = nanobind;

namespace gloam::python {

/// Raises the exception of gloam.errors that an Error is.
[[noreturn]] void raise(const Error& error);
/// The same by the name of its class: "ClosedError".
[[noreturn]] void raise(const char* type, const std::string& message, const std::string& hint = {});

inline void check(const Status& status) {
  if (!status.ok()) raise(status.error());
}
template <class T>
T take(Result<T> result) {
  if (!result.ok()) raise(result.error());
  return std::move(result).value();
}

/// Time after which a thread that waits sees a signal.
constexpr std::chrono::milliseconds kSignalPollPeriod{50};
/// Time in which callbacks and hooks have to return when their stream or simulation is closed.
constexpr std::chrono::seconds kCallbackTimeout{5};
/// Waits until `is_done` with the interpreter free meanwhile. Whether it was. Ctrl-C is raised.
bool wait_patiently(const std::function<bool()>& is_done,
                    std::chrono::seconds patience = kCallbackTimeout);

/// Runs `job` on another thread while this one looks after signals: a Ctrl-C calls `stop` and is
/// raised once the job has ended. For what may take longer than a tenth of a second.
void wait_for(const std::function<void()>& job, const std::function<void()>& stop);

/// A job's result, with the interpreter free for other threads meanwhile.
template <class F>
auto without_gil(F&& job) {
  const nb::gil_scoped_release released;
  return job();
}
/// The same, stopped by Ctrl-C.
template <class F>
auto interruptible(F&& job, const std::function<void()>& stop) {
  std::optional<decltype(job())> result;
  wait_for([&] { result.emplace(job()); }, stop);
  return std::move(*result);
}

/// The first exception of functions that C++ calls on other threads, until a call of Python's can
/// raise it.
class FirstError {
 public:
  void keep(nb::python_error&& error);
  void rethrow();
  /// For the collector of cycles, which holds the interpreter: the traceback of an exception refers
  /// to the objects of its functions.
  int traverse(visitproc visit, void* arg) const;
  void clear();

 private:
  std::mutex mutex_;
  std::unique_ptr<nb::python_error> error_;
};

/// A ProgressCallback that calls a Python function, or none. Its exception stops the job and is
/// raised by rethrow().
class PythonProgress {
 public:
  explicit PythonProgress(nb::object callable) : callable_(std::move(callable)) {}
  ProgressCallback callback();
  void stop() { stopped_ = true; }
  void rethrow() { error_.rethrow(); }

 private:
  bool tell(const Progress& progress);

  nb::object callable_;
  std::atomic<bool> stopped_{false};
  FirstError error_;
};

/// Runs a job that takes a ProgressCallback: with progress told to Python, stopped by Ctrl-C.
template <class F>
auto with_progress(nb::object callable, F&& job) {
  PythonProgress progress(std::move(callable));
  auto result = interruptible([&] { return job(progress.callback()); }, [&] { progress.stop(); });
  progress.rethrow();
  return take(std::move(result));
}

/// Keyword arguments: read by their names, and none is left over.
class Keywords {
 public:
  explicit Keywords(const nb::dict& given) : given_(given) {}
  /// Leaves `value` as it is where the name is not given, or is None.
  template <class T>
  void read(const char* name, T* value) {
    known_.emplace_back(name);
    if (given_.contains(name) && !given_[name].is_none()) *value = nb::cast<T>(given_[name]);
  }
  /// After all were read. Raises a UsageError, with the nearest, for a name that nobody read.
  void refuse_others() const;

 private:
  const nb::dict& given_;
  std::vector<std::string> known_;
};

/// While it lives this thread is in a callback or hook: what waits for the simulation is refused.
class CallbackScope {
 public:
  CallbackScope() { depth() += 1; }
  ~CallbackScope() { depth() -= 1; }
  CallbackScope(const CallbackScope&) = delete;
  CallbackScope& operator=(const CallbackScope&) = delete;
  static bool is_inside() { return depth() > 0; }

 private:
  static int& depth() {
    thread_local int depth = 0;
    return depth;
  }
};

/// Destroys something that waits for threads of a simulation: now, or, where this is one of them
/// (the collector of cycles may run in a callback), soon on the main thread; streams first.
enum class Kept { kStream, kRun };
void destroy_when_safe(Kept kind, std::function<void()> destroy);
/// Destroys now what still waits for it.
void destroy_deferred();

/// Numbers of any sequence or array of Python's, as doubles. Raises: no numbers.
std::vector<double> doubles(nb::handle numbers);
/// As many, else a ValueError that names `what`.
std::vector<double> doubles(nb::handle numbers, size_t count, const char* what);
Vec3 vec3(nb::handle numbers, const char* what);
/// (position (3), quaternion wxyz (4)), as Pose in Python; or a Pose, which has .p and .q.
Pose pose(nb::handle value);
nb::tuple pose_tuple(const Pose& X);

/// A NumPy array over memory that `owner` keeps.
template <class T>
nb::object array_over(const T* data, std::initializer_list<size_t> shape, nb::handle owner) {
  return nb::cast(
      nb::ndarray<nb::numpy, T>(const_cast<T*>(data), shape.size(), shape.begin(), owner));
}
/// A NumPy array that owns its numbers.
template <class T>
nb::object new_array(std::vector<T> values, std::initializer_list<size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape.size(), shape.begin(), owner));
}

/// Slots by which Python's collector finds, and breaks, cycles through objects that C++ keeps: a
/// callback that refers to its stream, an exception of a callback whose traceback refers to it. T
/// has traverse(), as FirstError has, and clear_kept().
template <class T>
PyType_Slot* kept_slots() {
  static PyType_Slot slots[] = {
      {Py_tp_traverse, reinterpret_cast<void*>(+[](PyObject* self, visitproc visit, void* arg) {
         Py_VISIT(Py_TYPE(self));
         return nb::inst_ready(self) ? nb::inst_ptr<T>(self)->traverse(visit, arg) : 0;
       })},
      {Py_tp_clear, reinterpret_cast<void*>(+[](PyObject* self) {
         nb::inst_ptr<T>(self)->clear_kept();
         return 0;
       })},
      {0, nullptr}};
  return slots;
}

// One function for each part of the module.
void bind_scene(nb::module_& m);
void bind_world(nb::module_& m);
void bind_snapshots(nb::module_& m);
void bind_simulation(nb::module_& m);
void bind_streams(nb::module_& m);
void bind_frames(nb::module_& m);
void bind_logs(nb::module_& m);
void bind_runs(nb::module_& m);
void bind_tools(nb::module_& m);
void bind_ik(nb::module_& m);
void bind_policy(nb::module_& m);

}  // namespace gloam::python
