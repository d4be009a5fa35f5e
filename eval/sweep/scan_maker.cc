#include "eval/sweep/scan_maker.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "eval/run/synthetic_source.h"
#include "eval/sweep/parallel.h"
#include "eval/sweep/scan_cache.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

constexpr const char* kScanFolder = "/scans";  // below the cache folder
constexpr int kImagesPerThread = 8;            // images in memory at a time, 1.2 MB each

// Sets that use the same depth images.
struct DepthJob {
  std::unique_ptr<SyntheticSensor> sensor;
  std::vector<ScanSet*> sets;
  std::vector<FrameScanner> scanners;  // one per set
};

// Loads the sets that are on disk and returns the others.
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
    } catch (const DiskFullError&) {  // of the cache's folder: no set is to blame
      throw;
    } catch (const std::exception& error) {
      set->failure = error.what();
    }
  }
  return jobs;
}

using Images = std::vector<std::shared_ptr<const DepthImage>>;

void ScanImages(const Images& images, int first, FrameScanner& scanner, ScanSet& set) {
  for (std::size_t k = 0; k < images.size(); ++k) {
    const std::size_t index = static_cast<std::size_t>(first) + k;
    const SlamPose& pose = set.slam.live[index];
    Frame frame;
    frame.depth = images[k];
    frame.slam_from_camera = pose.slam_from_camera;
    frame.stamp_s = pose.stamp_s;
    frame.slam_epoch = pose.epoch;
    set.scans[index] = scanner.ScansOf(frame);
  }
}

// A block of images is made in any order. Each set then reads them in order of time, because the
// floor is tracked from frame to frame.
void ScanBlock(DepthJob& job, int first, int count, int threads) {
  Images images(static_cast<std::size_t>(count));
  ForEachIndex(images.size(), threads, [&](std::size_t k) {
    images[k] = std::make_shared<const DepthImage>(job.sensor->Image(first + static_cast<int>(k)));
  });
  ForEachIndex(job.sets.size(), threads, [&](std::size_t i) {
    if (!job.sets[i]->failure.empty()) return;
    try {
      ScanImages(images, first, job.scanners[i], *job.sets[i]);
    } catch (const std::exception& error) {  // the other sets have their own scanners
      job.sets[i]->failure = error.what();
    }
  });
}

void ScanJob(DepthJob& job, const ScanMakerContext& context) {
  const int frames = job.sensor->FrameCount();
  const int block = kImagesPerThread * context.threads;
  for (int first = 0; first < frames; first += block) {
    const int count = std::min(block, frames - first);
    try {
      ScanBlock(job, first, count, context.threads);
    } catch (const std::exception& error) {  // an image could not be made
      for (ScanSet* set : job.sets) {
        if (set->failure.empty()) set->failure = error.what();
      }
    }
    const bool all_failed = std::all_of(job.sets.begin(), job.sets.end(),
                                        [](const ScanSet* set) { return !set->failure.empty(); });
    if (all_failed) return;
    for (int i = 0; i < count; ++i) context.tick();
  }
}

}  // namespace

void RequireUsableCache(const std::string& cache_folder) {
  if (!cache_folder.empty()) ScanCache(cache_folder + kScanFolder);
}

void MakeScans(const std::vector<ScanSet*>& sets, const ScanMakerContext& context) {
  std::optional<ScanCache> cache;
  if (!context.cache_folder.empty()) cache.emplace(context.cache_folder + kScanFolder);
  const std::vector<ScanSet*> missing = Missing(sets, cache, context);
  std::vector<DepthJob> jobs = JobsOf(missing, context.cache_folder);
  for (DepthJob& job : jobs) ScanJob(job, context);
  if (!cache) return;
  ForEachIndex(missing.size(), context.threads, [&](std::size_t i) {
    if (missing[i]->failure.empty()) cache->Store(ContentKey(*missing[i]), missing[i]->scans);
  });
}

}  // namespace depthgrid
