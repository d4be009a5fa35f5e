#include "eval/sweep/scan_maker.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "eval/parallel.h"
#include "eval/sweep/scan_cache.h"
#include "eval/synthetic_source.h"

namespace depthgrid {
namespace {

constexpr const char* kScanFolder = "/scans";  // below the cache folder

// Sets read from the same depth images.
struct DepthJob {
  std::unique_ptr<SyntheticSensor> sensor;
  std::vector<ScanSet*> sets;
  std::vector<FrameScanner> scanners;  // one a set
};

// Reads what is on disk; the rest is left to make.
std::vector<ScanSet*> Missing(const std::vector<ScanSet*>& sets,
                              const std::optional<ScanCache>& cache,
                              const ScanMakerContext& context) {
  std::vector<std::uint8_t> found(sets.size(), 0);
  std::mutex mutex;
  ForEachIndex(sets.size(), context.threads, [&](std::size_t i) {
    if (!sets[i]->failure.empty() || !cache) return;
    auto scans = cache->Load(ContentKey(*sets[i]));
    if (scans && scans->size() == sets[i]->slam.live.size()) {
      sets[i]->scans = std::move(*scans);
      found[i] = 1;
    }
    const std::lock_guard lock(mutex);
    context.tick();
  });
  std::vector<ScanSet*> missing;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (sets[i]->failure.empty() && found[i] == 0) missing.push_back(sets[i]);
  }
  return missing;
}

std::vector<DepthJob> JobsOf(const std::vector<ScanSet*>& sets, const std::string& cache_folder) {
  std::map<std::string, std::size_t> position;
  std::vector<DepthJob> jobs;
  for (ScanSet* set : sets) {
    try {
      const std::string key = DepthKey(*set);
      FrameScanner scanner(set->world->camera, set->options.mapper.scan);
      if (!position.contains(key)) {
        auto sensor = std::make_unique<SyntheticSensor>(*set->world, set->options, cache_folder);
        position[key] = jobs.size();
        jobs.push_back({std::move(sensor), {}, {}});
      }
      DepthJob& job = jobs[position[key]];
      job.sets.push_back(set);
      job.scanners.push_back(std::move(scanner));
      set->scans.resize(set->slam.live.size());
    } catch (const std::exception& error) {
      set->failure = error.what();
    }
  }
  return jobs;
}

void ScanFrame(const DepthJob& job, std::size_t index) {
  const auto depth = std::make_shared<const DepthImage>(job.sensor->Image(static_cast<int>(index)));
  for (std::size_t i = 0; i < job.sets.size(); ++i) {
    Frame frame;
    frame.depth = depth;
    frame.slam_from_camera = job.sets[i]->slam.live[index].slam_from_camera;
    FrameScanner scanner = job.scanners[i];  // a thread's own: it has memory
    job.sets[i]->scans[index] = scanner.ScansOf(frame);
  }
}

}  // namespace

void MakeScans(const std::vector<ScanSet*>& sets, const ScanMakerContext& context) {
  std::optional<ScanCache> cache;
  if (!context.cache_folder.empty()) cache.emplace(context.cache_folder + kScanFolder);
  const std::vector<ScanSet*> missing = Missing(sets, cache, context);
  const std::vector<DepthJob> jobs = JobsOf(missing, context.cache_folder);
  std::vector<std::pair<std::size_t, std::size_t>> frames;  // job, frame
  for (std::size_t job = 0; job < jobs.size(); ++job) {
    const int count = jobs[job].sensor->FrameCount();
    for (int i = 0; i < count; ++i) frames.emplace_back(job, static_cast<std::size_t>(i));
  }
  std::mutex mutex;
  ForEachIndex(frames.size(), context.threads, [&](std::size_t i) {
    const DepthJob& job = jobs[frames[i].first];
    try {
      ScanFrame(job, frames[i].second);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex);
      for (ScanSet* set : job.sets) set->failure = error.what();
    }
    const std::lock_guard lock(mutex);
    context.tick();
  });
  if (!cache) return;
  ForEachIndex(missing.size(), context.threads, [&](std::size_t i) {
    if (missing[i]->failure.empty()) cache->Store(ContentKey(*missing[i]), missing[i]->scans);
  });
}

}  // namespace depthgrid
