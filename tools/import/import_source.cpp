// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/import_source.hpp"

#include <fstream>
#include <optional>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "run/import/bag_folder.hpp"
#include "run/recording/recording_writer.hpp"
#include "tools/import/added_logs.hpp"
#include "tools/import/capture_source.hpp"
#include "tools/import/import_messages.hpp"
#include "tools/import/import_plan.hpp"
#include "tools/import/new_folder.hpp"
#include "tools/import/scan_files.hpp"
#include "tools/import/unreadable.hpp"

namespace isobar::tools {
namespace {

/// Share of the progress that the first look takes.
constexpr double kLookShare = 0.4;

std::string description_of(const ImportRequest& request, const ImportReport& report) {
  return "imported from " +
         printable(std::filesystem::absolute(request.source).lexically_normal().string(), 300) + " (" +
         report.container + ")";
}

/// Messages of a container.
void import_messages(const ImportRequest& request, AddedLogs& logs, ImportReport& report,
                     const std::function<void(double)>& progress) {
  const TopicSurvey survey =
      survey_topics(request.source, [&](double fraction) { progress(kLookShare * fraction); });
  if (const auto next = imports::next_part(request.source)) {
    report.notes.push_back(request.source.filename().string() + " is one part of a bag, " + printable(*next) +
                           " follows it: name the folder to read all parts");
  }
  ImportPlan plan = plan_import(survey, logs.without(request), report);
  if (plan.lidar) logs.align(survey.topics[plan.lidar->index].first_log_ns);
  logs.add_to(plan.manifest, request);
  if (!plan.manifest.lidar && !plan.manifest.imu && !plan.manifest.barometer &&
      !plan.manifest.base_barometer) {
    std::string topics;
    for (const TopicFindings& topic : survey.topics) {
      topics += (topics.empty() ? "" : ", ") + printable(topic.channel.topic) + " (" +
                printable(topic.channel.type) + ")";
    }
    throw DataError(request.source.string() + ": holds no lidar, IMU or barometer that is read" +
                    (topics.empty() ? "; it has no messages" : "; it has " + printable(topics, 2'000)) +
                    (report.notes.empty() ? "" : "; " + report.notes.front()));
  }
  plan.manifest.description = description_of(request, report);
  recording::RecordingWriter writer(request.out, plan.manifest);
  if (!plan.lidar_metadata.empty()) {
    const auto file = request.out / plan.manifest.lidar->calibration_file;
    std::ofstream calibration(file, std::ios::binary);
    calibration << plan.lidar_metadata;
    if (!calibration.flush()) throw ServiceError(file.string() + ": cannot be written");
  }
  write_messages(request, plan, writer, report.notes,
                 [&](double fraction) { progress(kLookShare + (1.0 - kLookShare) * fraction); });
  logs.write(writer, report);
  writer.close();
}

/// The mount of --mount; without it the lidar's frame is the robot's.
void place_lidar(const std::map<std::string, Mount>& mounts, recording::LidarEntry& lidar,
                 ImportReport& report) {
  if (const auto mount = mounts.find("lidar"); mount != mounts.end()) {
    lidar.mount = mount->second;
    return;
  }
  report.notes.emplace_back(
      "mounts: where the lidar sits on the robot is not known: poses are those of the lidar; "
      "--mount lidar=x,y,z,roll,pitch,yaw says it");
}

/// A capture of a lidar's packets.
void import_capture(const ImportRequest& request, AddedLogs& logs, ImportReport& report,
                    const std::function<void(double)>& progress) {
  const CaptureFindings findings =
      find_lidar(logs.without(request), report, [&](double fraction) { progress(kLookShare * fraction); });
  logs.align(findings.first_ns);
  recording::Manifest manifest;
  logs.add_to(manifest, request);
  manifest.description = description_of(request, report);
  recording::RecordingWriter writer(request.out, manifest);
  logs.write(writer, report);
  writer.close();
  place_capture(request, findings, request.out);
  manifest.lidar = findings.lidar;
  place_lidar(request.mounts(), *manifest.lidar, report);
  recording::write_manifest(request.out, manifest);
}

/// One file a scan.
void import_scans(const ImportRequest& request, AddedLogs& logs, ImportReport& report,
                  const std::function<void(double)>& progress) {
  const ScanFiles files = find_scans(request);
  report.container = files.type;
  logs.align(files.scans.front().stamp_ns);
  recording::Manifest manifest;
  manifest.lidar = recording::LidarEntry{};
  manifest.lidar->model = recording::kCloudModel;
  manifest.lidar->file = "lidar.clouds";
  const auto mounts = request.mounts();
  place_lidar(mounts, *manifest.lidar, report);
  if (!files.oxts.empty() && request.imu.empty() && mounts.contains("imu") && request.rate_hz <= 0.0) {
    logs.use_imu(read_oxts(files.oxts), files.oxts.string(), "KITTI oxts");
  } else if (!files.oxts.empty() && request.imu.empty()) {
    report.notes.push_back(
        "imu: " + printable(files.oxts.string()) +
        " is left out: --mount imu=x,y,z,roll,pitch,yaw says how it sits (calib_imu_to_velo.txt)");
  }
  logs.add_to(manifest, request);
  manifest.description = description_of(request, report);
  recording::RecordingWriter writer(request.out, manifest);
  write_scans(files, writer, report, progress);
  logs.write(writer, report);
  writer.close();
}

/// Logs alone: no lidar.
void import_log(const ImportRequest& request, AddedLogs& logs, ImportReport& report) {
  logs.use_source(request);
  report.container = "log";
  recording::Manifest manifest;
  logs.add_to(manifest, request);
  manifest.description = description_of(request, report);
  recording::RecordingWriter writer(request.out, manifest);
  logs.write(writer, report);
  writer.close();
}

}  // namespace

bool is_recording(const std::filesystem::path& source) {
  std::error_code error;
  return std::filesystem::exists(source / recording::kManifestFile, error);
}

bool is_importable(const std::filesystem::path& source) {
  return !is_recording(source) && (imports::holds_messages(source) || is_capture(source) ||
                                   holds_scans(source) || is_sample_log(source));
}

ImportReport import_source(const ImportRequest& request, const std::function<void(double)>& progress) {
  if (is_recording(request.source)) {
    throw UsageError(request.source.string() + ": is a recording already; isobar replay reads it as it is");
  }
  static_cast<void>(request.mounts());  // says what is wrong before anything is read
  ImportReport report;
  AddedLogs logs(request);
  NewFolder folder(request.out);
  if (imports::holds_messages(request.source)) {
    import_messages(request, logs, report, progress);
  } else if (is_capture(request.source)) {
    import_capture(request, logs, report, progress);
  } else if (holds_scans(request.source)) {
    import_scans(request, logs, report, progress);
  } else if (is_sample_log(request.source)) {
    import_log(request, logs, report);
  } else {
    throw DataError(why_unreadable(request.source));
  }
  folder.keep();
  return report;
}

}  // namespace isobar::tools
