// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import_options.hpp"

#include <cstdio>

#include "tools/import/import_source.hpp"
#include "tools/progress.hpp"
#include "tools/stop_signals.hpp"

namespace isobar::tools {

void add_import_options(CLI::App& command, ImportRequest& request) {
  constexpr const char* kGroup = "Of a foreign source";
  const auto add = [&](const char* name, auto& value, const char* text) {
    command.add_option(name, value, text)->group(kGroup);
  };
  add("--lidar", request.lidar, "topic of the lidar (a capture: its UDP port), or none");
  add("--imu", request.imu,
      "topic of the IMU, the file of its log (CSV, VN-100, Xsens, ULog, dataflash), or none");
  add("--pressure", request.pressure, "topic of the robot's barometer, the file of its log, or none");
  add("--base-pressure", request.base_pressure,
      "topic of the base station's barometer, the file of its log, or none");
  add("--wheel", request.wheel, "topic of the wheel odometry, or none");
  add("--reference", request.reference, "topic of true poses, a file in the TUM format, or none");
  command
      .add_option(
          "--mount", request.mount_texts,
          "lidar=x,y,z,roll,pitch,yaw in base_link (m, degrees); also imu= and barometer=; may be repeated")
      ->allow_extra_args(false)
      ->group(kGroup);
  add("--base-frame", request.base_frame, "frame of the robot in /tf_static (default: base_link)");
  add("--model", request.model,
      "model of the lidar whose packets the source holds (default: by the packets)");
  add("--calibration", request.calibration_file, "calibration of that lidar: see lidar.calibration_file");
  add("--rate", request.rate_hz, "scans, or readings of a log, a second, where nothing tells their times");
  add("--log-offset", request.log_offset_s,
      "for logs that count from their start: time from the lidar's first packet to the log's first sample "
      "[s]");
  add("--gyro-unit", request.gyro_unit, "rad/s or deg/s (default: by the values)");
  add("--accel-unit", request.accel_unit, "m/s2, g or mg (default: by the values)");
  add("--pressure-unit", request.pressure_unit, "Pa, hPa or kPa (default: by the values)");
}

void import_and_print(const ImportRequest& request) {
  Progress progress("importing");
  const ImportReport report = import_source(request, [&](double fraction) {
    StopSignals::check();
    progress.update(fraction);
  });
  progress.finish();
  std::printf("%s: %s\n", request.source.c_str(), report.container.c_str());
  for (const std::string& line : table_of(report)) std::printf("%s\n", line.c_str());
  for (const std::string& note : report.notes) std::printf("note: %s\n", note.c_str());
}

}  // namespace isobar::tools
