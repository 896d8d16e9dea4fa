#include "runtime/recording/run_metrics.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "runtime/rendering/light_probe.h"
#include "sensors/probe/visibility_probe.h"
#include "sim/commands/command_check.h"

namespace gloam {

Result<std::unique_ptr<Metrics>> make_metrics(const World& world, LiveSimulation& simulation,
                                              const RunMetricsRequest& request) {
  const CompiledWorld& compiled = *world.compiled();
  const bool lit =
      metrics_name(compiled.scene, "illuminance") ||
      (request.records && std::ranges::any_of(compiled.robots, [&](const RobotInstance& r) {
         return r.root_body > 0 && floating_joint(*compiled.model, r.root_body) >= 0;
       }));
  MetricProbes probes;
  VisibilityProbe visibility;
  if (request.has_renderer || lit) {
    GLOAM_TRY(auto shared, simulation.renderer());
    GLOAM_TRY(visibility, VisibilityProbe::make(shared->description));
    if (lit) {
      GLOAM_TRY(std::shared_ptr<LightProbe> light, LightProbe::make(std::move(shared)));
      probes.illuminance = [light](const Snapshot& snapshot, const std::vector<Vec3>& places) {
        return light->illuminance(snapshot, places);
      };
    }
  } else {
    GLOAM_TRY(visibility, VisibilityProbe::make(compiled));
  }
  if (visibility.has_media() || metrics_name(compiled.scene, "visibility")) {
    auto probe = std::make_shared<VisibilityProbe>(std::move(visibility));
    probes.visibility = [probe](const SnapshotData& snapshot, Vec3f p_W) {
      return probe->visibility(snapshot, p_W);
    };
  }
  probes.sources = simulation.probe_sources();
  probes.light_every = std::max<int64_t>(1, std::llround(request.rate));  // once a second
  return Metrics::make(compiled, std::move(probes));
}

MetricsThread::MetricsThread(std::shared_ptr<SnapshotQueue> queue, Metrics& metrics,
                             StateTable* state, Recorder* recorder)
    : queue_(std::move(queue)), thread_([this, &metrics, state, recorder] {
        while (const Snapshot snapshot = queue_->next()) {
          const std::vector<double>& row = metrics.sample(snapshot);
          if (recorder == nullptr) continue;
          recorder->add_metrics(row);
          if (state == nullptr) continue;
          if (const auto values = state->row(snapshot); values.ok())
            recorder->add_state(*values);
          else
            log_warning("state.csv has no row for t = {} s: {}", snapshot.time(),
                        values.error().to_string());
        }
      }) {}

void MetricsThread::join() {
  queue_->close();
  if (thread_.joinable()) thread_.join();
}

}  // namespace gloam
