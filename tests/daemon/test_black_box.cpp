// SPDX-License-Identifier: BSD-3-Clause
// Ring, saver and fault trigger of the black box, without shared memory.
#include <doctest/doctest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "daemon/black_box_folder.hpp"
#include "daemon/black_box_ring.hpp"
#include "daemon/black_box_saver.hpp"
#include "daemon/black_box_trigger.hpp"
#include "run/recording/manifest.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_black_box {

using namespace isobar::black_box;
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kStart = 1'700'000'000 * kSecondNs;
constexpr std::uint64_t kPlenty = 100'000'000;
const std::atomic<bool> kGoOn{false};

recording::InputLog head() {
  recording::Manifest manifest = recording::Manifest::with_all_sensors();
  manifest.reference.reset();
  recording::InputLog log;
  REQUIRE(log.add_description(0, recording::manifest_text(manifest), "method = \"3dof\"\n"));
  return log;
}

recording::InputLog imu_at(std::int64_t stamp_ns) {
  recording::InputLog log;
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  sample.accel_m_s2 = {0.0, 0.0, 9.81};
  log.add(sample);
  return log;
}

/// A ring with one IMU sample in each tenth of a second.
void fill(Ring& ring, int seconds) {
  for (int i = 0; i < 10 * seconds; ++i) {
    const std::int64_t now_ns = i * kSecondNs / 10;
    REQUIRE(ring.append(imu_at(kStart + now_ns), now_ns));
  }
}

fs::path made(const fs::path& folder) {
  fs::create_directories(folder);
  return folder;
}

std::vector<std::int64_t> stamps_of(const fs::path& recording) {
  recording::RecordingReader reader(recording);
  std::vector<std::int64_t> stamps;
  for (recording::Event event; reader.next(event);) stamps.push_back(event.stamp_ns);
  return stamps;
}

SaveJob job_of(const Ring& ring, const std::string& reason = "order") {
  SaveJob job;
  job.segments = ring.open_all();
  job.reason = reason;
  job.utc_s = 1'795'897'277;  // 2026-11-28 20:21:17 UTC
  return job;
}

ipc::HealthReport report_with(const char* name, ipc::HealthLevel level) {
  ipc::HealthReport report;
  REQUIRE(report.add(name, level, "", 0.0));
  return report;
}

}  // namespace

TEST_CASE("a ring holds its span and at most one segment more, and its recording has no gap") {
  const TemporaryFolder folder;
  Ring ring(made(folder.path() / "ring"), 60 * kSecondNs, kPlenty);
  ring.set_head(head());
  fill(ring, 200);
  const std::int64_t end_ns = 1'999 * kSecondNs / 10;
  CHECK(ring.held_ns(end_ns) >= 60 * kSecondNs);
  CHECK(ring.held_ns(end_ns) <= 65 * kSecondNs);
  const fs::path saved = save_ring(job_of(ring), {folder.path() / "saved", 10, 0.0}, kGoOn);
  const auto stamps = stamps_of(saved);
  REQUIRE(stamps.size() >= 600);
  CHECK(stamps.back() == kStart + end_ns);
  for (std::size_t i = 1; i < stamps.size(); ++i) REQUIRE(stamps[i] - stamps[i - 1] == kSecondNs / 10);
  std::uint64_t on_disk = 0;
  for (const auto& file : fs::directory_iterator(folder.path() / "ring")) on_disk += file.file_size();
  CHECK(on_disk == ring.held_bytes());
}

TEST_CASE("a ring keeps below its memory limit by dropping the oldest inputs") {
  const TemporaryFolder folder;
  constexpr std::uint64_t kLimit = 40'000;
  Ring ring(made(folder.path() / "ring"), 600 * kSecondNs, kLimit);
  ring.set_head(head());
  for (int i = 0; i < 6'000; ++i) {
    REQUIRE(ring.append(imu_at(kStart + i * kSecondNs / 10), i * kSecondNs / 10));
    REQUIRE(ring.held_bytes() <= kLimit);
  }
  const auto stamps = stamps_of(save_ring(job_of(ring), {folder.path() / "saved", 10, 0.0}, kGoOn));
  CHECK(stamps.back() == kStart + 5'999 * kSecondNs / 10);
  CHECK(stamps.size() > 100);
}

TEST_CASE("a ring whose last segment is cut at any byte is saved up to the cut") {
  const TemporaryFolder folder;
  const fs::path ring_folder = made(folder.path() / "ring");
  Ring ring(ring_folder, 60 * kSecondNs, kPlenty);
  ring.set_head(head());
  fill(ring, 1);
  const fs::path segment = fs::directory_iterator(ring_folder)->path();
  const auto full = fs::file_size(segment);
  const auto record = imu_at(kStart).bytes().size();
  for (std::size_t cut = 1; cut < 2 * record; ++cut) {
    fs::resize_file(segment, full - cut);
    SaveJob job;
    job.left_over = ring_folder;
    job.reason = "crash";
    const fs::path saved = save_ring(job, {folder.path() / "saved", 1, 0.0}, kGoOn);
    REQUIRE_MESSAGE(stamps_of(saved).size() == (cut <= record ? 9 : 8), "cut by " << cut << " bytes");
  }
}

TEST_CASE("a segment that the ring drops during a save is still saved") {
  const TemporaryFolder folder;
  Ring ring(made(folder.path() / "ring"), 12 * kSecondNs, kPlenty);
  ring.set_head(head());
  fill(ring, 10);
  const SaveJob job = job_of(ring);
  ring.remove();
  CHECK(stamps_of(save_ring(job, {folder.path() / "saved", 10, 0.0}, kGoOn)).size() == 100);
}

TEST_CASE("the newest saves are kept, with the new one in any case, and nothing else is touched") {
  const TemporaryFolder folder;
  const fs::path saved = folder.path() / "saved";
  for (const char* name :
       {"20990101T000000Z-order", "20990102T000000Z-order", "20990103T000000Z-fault-lidar"}) {
    made(saved / name);
    std::ofstream(saved / name / recording::kManifestFile) << "version = 1\n";
  }
  made(saved / "20000101T000000Z-mine");  // no recording
  made(saved / "my recordings");
  made(saved / ".draft-20200101T000000Z-crash");
  Ring ring(made(folder.path() / "ring"), 60 * kSecondNs, kPlenty);
  ring.set_head(head());
  fill(ring, 1);
  const fs::path first = save_ring(job_of(ring, "My Reason!/.."), {saved, 2, 0.0}, kGoOn);
  CHECK(first == saved / "20261128T202117Z-my-reason----");
  CHECK(fs::exists(first));
  CHECK_FALSE(fs::exists(saved / "20990101T000000Z-order"));
  CHECK_FALSE(fs::exists(saved / "20990102T000000Z-order"));
  CHECK(fs::exists(saved / "20990103T000000Z-fault-lidar"));
  CHECK(fs::exists(saved / "20000101T000000Z-mine"));
  CHECK(fs::exists(saved / "my recordings"));
  CHECK_FALSE(fs::exists(saved / ".draft-20200101T000000Z-crash"));
  const fs::path second = save_ring(job_of(ring, "My Reason!/.."), {saved, 10, 0.0}, kGoOn);
  CHECK(second == saved / "20261128T202117Z-my-reason-----2");
}

TEST_CASE("a save without space, without inputs or without a folder is refused and leaves nothing behind") {
  const TemporaryFolder folder;
  const fs::path saved = folder.path() / "saved";
  Ring ring(made(folder.path() / "ring"), 60 * kSecondNs, kPlenty);
  ring.set_head(head());
  const auto refusal = [&](const SaverSettings& settings, const std::atomic<bool>& cancelled) {
    return message_of([&] { save_ring(job_of(ring), settings, cancelled); });
  };
  CHECK(refusal({saved, 10, 0.0}, kGoOn).find("no input yet") != std::string::npos);
  fill(ring, 1);
  CHECK(refusal({saved, 10, 1e12}, kGoOn).find("MB free") != std::string::npos);
  CHECK(refusal({{}, 10, 0.0}, kGoOn).find("black_box.directory") != std::string::npos);
  CHECK(refusal({saved, 10, 0.0}, std::atomic<bool>{true}).find("given up") != std::string::npos);
  CHECK(fs::is_empty(saved));
}

TEST_CASE("a chosen entry that becomes an error saves the black box, at most once in five minutes") {
  using ipc::HealthLevel;
  FaultTrigger trigger("lidar barometer");
  CHECK_FALSE(trigger.check(report_with("lidar", HealthLevel::kError), 0));  // from the start: no change
  CHECK_FALSE(trigger.check(report_with("lidar", HealthLevel::kOk), kSecondNs));
  CHECK(trigger.check(report_with("lidar", HealthLevel::kError), 2 * kSecondNs) == "lidar");
  CHECK_FALSE(trigger.check(report_with("lidar", HealthLevel::kError), 3 * kSecondNs));
  CHECK_FALSE(trigger.check(report_with("lidar", HealthLevel::kOk), 4 * kSecondNs));
  CHECK_FALSE(trigger.check(report_with("lidar", HealthLevel::kError), 5 * kSecondNs));  // too soon
  CHECK_FALSE(trigger.check(report_with("lidar", HealthLevel::kWarning), 400 * kSecondNs));
  CHECK(trigger.check(report_with("lidar", HealthLevel::kError), 401 * kSecondNs) == "lidar");
  CHECK_FALSE(trigger.check(report_with("imu", HealthLevel::kOk), 900 * kSecondNs));
  CHECK_FALSE(trigger.check(report_with("imu", HealthLevel::kError), 901 * kSecondNs));  // not chosen
  CHECK_FALSE(trigger.check(report_with("barometer/stuck", HealthLevel::kOk), 902 * kSecondNs));
  CHECK(trigger.check(report_with("barometer/stuck", HealthLevel::kError), 903 * kSecondNs) ==
        "barometer/stuck");
  FaultTrigger never("none");
  CHECK_FALSE(never.check(report_with("lidar", HealthLevel::kOk), 0));
  CHECK_FALSE(never.check(report_with("lidar", HealthLevel::kError), kSecondNs));
}

TEST_CASE("a memory folder of another user, or open to others, is not used") {
  const TemporaryFolder folder;
  setenv("RUNTIME_DIRECTORY", folder.path().c_str(), 1);
  const fs::path memory = memory_folder();
  CHECK(memory == folder.path() / "blackbox");
  CHECK((fs::status(memory).permissions() & (fs::perms::group_all | fs::perms::others_all)) ==
        fs::perms::none);
  made(memory / "ring-20200101T000000Z-1");
  CHECK(left_over_rings(memory).size() == 1);
  fs::permissions(memory, fs::perms::all);
  CHECK(message_of([] { (void)memory_folder(); }).find("no private folder") != std::string::npos);
  unsetenv("RUNTIME_DIRECTORY");
}

}  // namespace isobar::test::test_black_box
