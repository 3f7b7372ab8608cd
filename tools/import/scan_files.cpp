// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/scan_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <system_error>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "core/printable_text.hpp"
#include "run/import/point_files.hpp"
#include "run/import/point_text.hpp"
#include "run/recording/date_text.hpp"
#include "run/text/number_text.hpp"

namespace isobar::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr std::int64_t kYear2000S = 946'684'800;
/// Scans a second of most lidars that turn.
constexpr double kAssumedRateHz = 10.0;

/// "9.pcd" comes before "10.pcd": digits compare as numbers.
bool comes_first(const fs::path& a, const fs::path& b) {
  const std::string x = a.filename();
  const std::string y = b.filename();
  std::size_t i = 0;
  std::size_t k = 0;
  const auto digits = [](const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
    return text.substr(at, end - at);
  };
  while (i < x.size() && k < y.size()) {
    const std::string p = digits(x, i);
    const std::string q = digits(y, k);
    if (!p.empty() && !q.empty()) {
      const std::string p0 = p.substr(std::min(p.find_first_not_of('0'), p.size() - 1));
      const std::string q0 = q.substr(std::min(q.find_first_not_of('0'), q.size() - 1));
      if (p0 != q0) return p0.size() != q0.size() ? p0.size() < q0.size() : p0 < q0;
      i += p.size();
      k += q.size();
      continue;
    }
    if (x[i] != y[k]) return x[i] < y[k];
    ++i;
    ++k;
  }
  return x.size() - i < y.size() - k;
}

std::vector<fs::path> point_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && imports::is_point_file(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), comes_first);
  return files;
}

/// The folder that holds the point files of a source.
fs::path folder_of_scans(const fs::path& source) {
  for (const char* below :
       {"", "velodyne_points/data", "velodyne", "velodyne_points", "data", "Ouster", "sensor_data/Ouster",
        "ouster_scan", "lidar", "pcd", "scans", "clouds", "points"}) {
    if (!point_files_in(source / below).empty()) return source / below;
  }
  return {};
}

std::vector<std::int64_t> read_times(const fs::path& file) {
  std::vector<std::int64_t> times;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string_view text = text::trimmed(line);
    if (text.empty()) continue;
    std::int64_t stamp_ns = 0;
    double seconds = 0.0;
    const bool is_seconds = text::parse_seconds(text, stamp_ns);
    if (!is_seconds && text::parse_number(text, seconds) && seconds >= 0.0 && seconds < 4e9) {
      stamp_ns = std::llround(seconds * 1e9);  // KITTI writes 1.036224e-01
    } else if (!is_seconds && !recording::parse_date(text, stamp_ns)) {
      throw DataError(file.string() + ":" + std::to_string(times.size() + 1) + ": is no time");
    }
    times.push_back(stamp_ns);
  }
  return times;
}

/// Times of a file beside the scans; false where there is none.
bool use_file_of_times(const fs::path& folder, ScanFiles& files) {
  for (const fs::path& file : {folder / "times.txt", folder / "timestamps.txt", folder / "../times.txt",
                               folder / "../timestamps.txt"}) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) continue;
    const std::vector<std::int64_t> times = read_times(file);
    if (times.size() < files.scans.size()) {
      throw DataError(file.lexically_normal().string() + ": has " + std::to_string(times.size()) +
                      " times for " + std::to_string(files.scans.size()) + " scans");
    }
    for (std::size_t i = 0; i < files.scans.size(); ++i) files.scans[i].stamp_ns = times[i];
    files.timing = "times are those of " + file.lexically_normal().filename().string();
    return true;
  }
  return false;
}

bool use_names(ScanFiles& files) {
  std::int64_t last_ns = 0;
  for (ScanFiles::Scan& scan : files.scans) {
    const auto stamp_ns = stamp_of_name(scan.file.stem());
    if (!stamp_ns || *stamp_ns <= last_ns) return false;
    scan.stamp_ns = last_ns = *stamp_ns;
  }
  files.timing = "times are those in the names of the files";
  return true;
}

void count_from_zero(double rate_hz, ScanFiles& files) {
  for (std::size_t i = 0; i < files.scans.size(); ++i) {
    files.scans[i].stamp_ns = std::llround(static_cast<double>(i) / rate_hz * 1e9);
  }
}

/// Whether logs come beside the scans, whose times would have to fit.
bool has_other_logs(const ImportRequest& request) {
  for (const std::string* log :
       {&request.imu, &request.pressure, &request.base_pressure, &request.wheel, &request.reference}) {
    if (!log->empty() && *log != kNoTopic) return true;
  }
  return false;
}

}  // namespace

bool holds_scans(const fs::path& source) {
  std::error_code error;
  if (fs::is_directory(source, error)) return !folder_of_scans(source).empty();
  return fs::is_regular_file(source, error) && (source.extension() == ".pcd" || source.extension() == ".ply");
}

std::optional<std::int64_t> stamp_of_name(const std::string& stem) {
  std::size_t begin = stem.find_first_of("0123456789");
  if (begin == std::string::npos) return std::nullopt;
  const std::size_t end = std::min(stem.find_first_not_of("0123456789", begin), stem.size());
  const std::string whole = stem.substr(begin, end - begin);
  std::int64_t value = 0;
  if (!text::parse_number(whole, value)) return std::nullopt;
  std::int64_t stamp_ns = 0;
  if (whole.size() == 10) {
    stamp_ns = value * kNsPerS;
    if (end < stem.size() && (stem[end] == '.' || stem[end] == '_')) {
      std::string fraction = stem.substr(end + 1);
      fraction.resize(std::min(fraction.find_first_not_of("0123456789"), fraction.size()));
      fraction.resize(9, '0');
      std::int64_t ns = 0;
      if (text::parse_number(fraction, ns)) stamp_ns += ns;
    }
  } else if (whole.size() == 13) {
    stamp_ns = value * 1'000'000;
  } else if (whole.size() == 16) {
    stamp_ns = value * 1'000;
  } else if (whole.size() == 19) {
    stamp_ns = value;
  }
  return stamp_ns >= kYear2000S * kNsPerS && implausible_stamp(stamp_ns) == nullptr ? std::optional(stamp_ns)
                                                                                    : std::nullopt;
}

ScanFiles find_scans(const ImportRequest& request) {
  ScanFiles files;
  std::error_code error;
  fs::path folder;
  if (fs::is_directory(request.source, error)) {
    folder = folder_of_scans(request.source);
    for (const fs::path& file : point_files_in(folder)) files.scans.push_back({file, 0});
  } else {
    folder = request.source.parent_path();
    files.scans.push_back({request.source, 0});
  }
  if (files.scans.empty())
    throw DataError(request.source.string() + ": holds no .pcd, .ply or .bin files of scans");
  const std::string extension = files.scans.front().file.extension();
  files.type = extension == ".pcd" ? "PCD" : extension == ".ply" ? "PLY" : "KITTI";
  for (const fs::path& oxts : {request.source / "oxts", folder / "../../oxts"}) {
    if (fs::is_directory(oxts / "data", error) && files.type == "KITTI") files.oxts = oxts.lexically_normal();
  }
  if (request.rate_hz > 0.0) {
    count_from_zero(request.rate_hz, files);
    files.timing = "times are counted from 0 by --rate";
    return files;
  }
  if (files.scans.size() == 1 || use_file_of_times(folder, files) || use_names(files)) return files;
  if (files.oxts.empty() && !has_other_logs(request)) {
    // Of a lidar alone the rate only scales times and speeds: path and map are the same.
    count_from_zero(kAssumedRateHz, files);
    files.timing =
        "neither a times.txt nor the names of the files tell when the scans were taken: 10 a second "
        "are assumed, which scales times and speeds; --rate says otherwise";
    return files;
  }
  throw UsageError("--rate: neither a times.txt nor the names of the files (" +
                   printable(files.scans.front().file.filename().string()) +
                   " …) tell when the scans were taken; say --rate HZ, such as --rate 10");
}

void write_scans(const ScanFiles& files, recording::RecordingWriter& writer, ImportReport& report,
                 const std::function<void(double)>& progress) {
  std::uint64_t written = 0;
  std::string first_error;
  recording::Tally cut;
  for (std::size_t i = 0; i < files.scans.size(); ++i) {
    progress(static_cast<double>(i) / static_cast<double>(files.scans.size()));
    try {
      std::string damage;
      recording::CloudRecord cloud = imports::read_point_file(files.scans[i].file, &damage);
      if (!damage.empty()) cut.add([&] { return damage; });
      cloud.stamp_ns = files.scans[i].stamp_ns;
      written += writer.add_cloud(cloud) ? 1 : 0;
    } catch (const DataError& error) {
      if (first_error.empty()) first_error = error.what();
    }
  }
  if (written == 0) throw DataError(first_error);
  if (cut.count > 0) {
    report.notes.push_back("damaged: " + cut.first_message +
                           (cut.count > 1 ? " (and " + std::to_string(cut.count - 1) + " more files)" : ""));
  }
  if (written < files.scans.size()) {
    report.notes.push_back(std::to_string(files.scans.size() - written) +
                           " files are left out, the first: " + first_error);
  }
  const double span_s =
      static_cast<double>(files.scans.back().stamp_ns - files.scans.front().stamp_ns) * 1e-9;
  report.rows.push_back(
      {files.scans.front().file.filename().string() + (files.scans.size() > 1 ? " …" : ""), files.type,
       written, span_s > 0.0 ? static_cast<double>(files.scans.size() - 1) / span_s : 0.0, "lidar.clouds"});
  if (!files.timing.empty()) report.notes.push_back("clock: " + files.timing);
}

std::vector<ImuSample> read_oxts(const fs::path& folder) {
  constexpr std::size_t kLeastFields = 20;
  std::vector<ImuSample> samples;
  const std::vector<std::int64_t> times = read_times(folder / "timestamps.txt");
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / "data", error)) files.push_back(entry.path());
  std::sort(files.begin(), files.end(), comes_first);
  for (std::size_t i = 0; i < std::min(files.size(), times.size()); ++i) {
    std::ifstream in(files[i]);
    std::string line;
    std::getline(in, line);
    std::vector<double> values;
    for (const std::string_view word : imports::words_of(line)) {
      double value = 0.0;
      if (!text::parse_number(word, value)) break;
      values.push_back(value);
    }
    if (values.size() < kLeastFields) continue;
    ImuSample sample;
    sample.stamp_ns = times[i];
    sample.accel_m_s2 = {values[11], values[12], values[13]};
    sample.gyro_rad_s = {values[17], values[18], values[19]};
    if (implausibility(sample) == nullptr) samples.push_back(sample);
  }
  return samples;
}

}  // namespace isobar::tools
