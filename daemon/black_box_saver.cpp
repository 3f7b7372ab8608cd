// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/black_box_saver.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "daemon/black_box_folder.hpp"
#include "run/recording/record_session.hpp"

namespace isobar::black_box {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kDraftPrefix = ".draft-";
constexpr double kMbBytes = 1e6;
/// Size of the recording in terms of the ring's: text is longer than binary samples, packets are the same.
constexpr double kGrowth = 1.2;
/// Niceness of the saver: everything else comes first.
constexpr int kNiceness = 15;

std::vector<std::uint8_t> read_segment(const OpenSegment& segment) {
  std::vector<std::uint8_t> bytes(segment.bytes);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pread(segment.file.get(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

void require_disk_space(const std::vector<OpenSegment>& segments, const SaverSettings& settings) {
  double needed_mb = settings.min_free_mb;
  for (const OpenSegment& segment : segments) {
    needed_mb += static_cast<double>(segment.bytes) * kGrowth / kMbBytes;
  }
  const double free_mb = static_cast<double>(recording::free_bytes(settings.folder)) / kMbBytes;
  if (free_mb < needed_mb) {
    throw ServiceError(settings.folder.string() + ": " + std::to_string(static_cast<long>(free_mb)) +
                       " MB free, " + std::to_string(static_cast<long>(needed_mb)) +
                       " MB needed to save and to leave black_box.min_free_mb");
  }
}

void write_segments(const std::vector<OpenSegment>& segments, recording::RecordSession& session,
                    const std::atomic<bool>& cancelled) {
  recording::LogEntry entry;
  for (const OpenSegment& segment : segments) {
    if (cancelled) throw ServiceError("isobard stops; saving was given up");
    const std::vector<std::uint8_t> bytes = read_segment(segment);
    recording::InputLogReader reader(bytes);
    while (reader.next(entry)) session.add(entry);
    session
        .flush();  // piece by piece, so that a stop never waits for a minute of inputs to reach a slow disk
  }
}

/// A ring without a single input: nothing is lost with it.
class EmptyRing : public ServiceError {
 public:
  EmptyRing() : ServiceError("the black box holds no input yet") {}
};

/// A name that is free: a second save within a second gets a number.
fs::path free_name(const fs::path& folder, const std::string& name) {
  fs::path path = folder / name;
  for (int i = 2; fs::exists(path); ++i) path = folder / (name + "-" + std::to_string(i));
  return path;
}

/// Removes a draft and its further folders unless they were renamed.
class Draft {
 public:
  Draft(fs::path folder, const std::string& name)
      : folder_(std::move(folder)), name_(std::string(kDraftPrefix) + name) {
    remove();
  }
  ~Draft() { remove(); }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  [[nodiscard]] fs::path path() const { return folder_ / name_; }

 private:
  void remove() const noexcept {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
      if (entry.path().filename().string().starts_with(kDraftPrefix)) fs::remove_all(entry.path(), error);
    }
  }

  fs::path folder_;
  std::string name_;
};

}  // namespace

fs::path save_ring(const SaveJob& job, const SaverSettings& settings, const std::atomic<bool>& cancelled) {
  if (settings.folder.empty()) {
    throw ServiceError("no folder for recordings: set black_box.directory or output.directory");
  }
  fs::create_directories(settings.folder);
  const std::vector<OpenSegment> left_over =
      job.left_over.empty() ? std::vector<OpenSegment>{} : open_segments(job.left_over);
  const std::vector<OpenSegment>& segments = job.left_over.empty() ? job.segments : left_over;
  require_disk_space(segments, settings);
  const std::string name = save_name(job.utc_s, job.reason);
  const Draft draft(settings.folder, name);
  recording::RecordSession session(draft.path());
  write_segments(segments, session, cancelled);
  if (session.counts().all() == 0) throw EmptyRing();
  session.close();
  fs::path first;
  for (const fs::path& folder : session.folders()) {
    const fs::path path = free_name(settings.folder, name);
    fs::rename(folder, path);
    if (first.empty()) first = path;
  }
  recording::sync_folder(settings.folder);
  delete_old_saves(settings.folder, settings.keep, first);
  return first;
}

void Saver::Jobs::add(SaveJob job) {
  const std::lock_guard lock(mutex_);
  jobs_.push_back(std::move(job));
  changed_.notify_one();
}

bool Saver::Jobs::take(SaveJob& job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || !jobs_.empty(); });
  if (stopped_) return false;
  job = std::move(jobs_.front());
  jobs_.pop_front();
  return true;
}

void Saver::Jobs::stop() noexcept {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_one();
}

Saver::Saver(SaverSettings settings)
    : settings_(std::move(settings)), worker_({.name = "blackbox-save"}, jobs_, [this] { loop(); }) {}

void Saver::submit(SaveJob job) { jobs_.add(std::move(job)); }

std::vector<SaveResult> Saver::take_results() {
  const std::lock_guard lock(results_mutex_);
  return std::exchange(results_, {});
}

void Saver::loop() noexcept {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNiceness);
  SaveJob job;
  while (jobs_.take(job)) {
    SaveResult result = save(job);
    job = SaveJob{};  // closes the segments, whose memory the ring may have dropped
    const std::lock_guard lock(results_mutex_);
    results_.push_back(std::move(result));
  }
}

SaveResult Saver::save(const SaveJob& job) noexcept {
  std::error_code ignored;
  try {
    const fs::path saved = save_ring(job, settings_, jobs_.stopped());
    spdlog::info("black box saved ({}): {}", job.reason, saved.string());
    if (!job.left_over.empty()) fs::remove_all(job.left_over, ignored);
    return {job.order, false, saved.string()};
  } catch (const EmptyRing& error) {
    if (!job.left_over.empty()) fs::remove_all(job.left_over, ignored);
    return {job.order, true, error.what()};
  } catch (const std::exception& error) {
    spdlog::warn("black box not saved ({}): {}", job.reason, error.what());
    return {job.order, true, error.what()};
  }
}

}  // namespace isobar::black_box
