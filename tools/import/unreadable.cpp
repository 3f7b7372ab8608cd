// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/unreadable.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "core/printable_text.hpp"
#include "run/import/file_bytes.hpp"

namespace isobar::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWhatIsRead =
    "rosbag1, rosbag2, MCAP, pcap, folders of PCD, PLY or KITTI scans, ULog, dataflash and the bytes of a "
    "VN-100 or Xsens are read";

/// First bytes of formats that are told apart only to say what to do.
struct KnownFormat {
  std::string_view magic;
  const char* text;
};
constexpr std::array kKnownFormats{
    KnownFormat{"#ROSBAG V1", "is a ROS 1 bag of an old version; `rosbag fix` of ROS 1 makes 2.0 of it"},
    KnownFormat{"PK\x03\x04", "is a zip archive; unpack it first"},
    KnownFormat{"7z\xbc\xaf\x27\x1c", "is a 7z archive; unpack it first"},
    KnownFormat{"\xfd\x37zXZ", "is compressed with xz; unpack it with `xz -dk` first"},
    KnownFormat{"BZh", "is compressed with bzip2 as a whole; unpack it with `bzip2 -dk` first"},
    KnownFormat{"LASF", "is a map in LAS or LAZ, no recording of single scans"},
    KnownFormat{"ASTM-E57", "is a map in E57, no recording of single scans"},
    KnownFormat{"\x89HDF", "is HDF5, which is not read"},
};

bool is_text(std::string_view head) {
  return std::all_of(head.begin(), head.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= ' ' || c == '\n' || c == '\r' || c == '\t';
  });
}

std::string name_of(const fs::path& path) { return printable(path.filename().string(), 100); }

std::string why_file(const fs::path& file) {
  constexpr std::size_t kHeadBytes = 512;
  const std::string head = imports::head_of(file, kHeadBytes);
  if (head.empty()) return "is empty";
  for (const KnownFormat& format : kKnownFormats) {
    if (head.starts_with(format.magic)) return format.text;
  }
  // A tar archive has its magic behind the name and the rights of its first file.
  if (head.size() > 262 && head.compare(257, 5, "ustar") == 0) return "is a tar archive; unpack it first";
  if (is_text(head)) {
    return "is text, beginning with \"" + printable(head.substr(0, head.find_first_of("\r\n")), 60) +
           "\"; a log of an IMU or barometer comes beside a lidar: isobar replay LIDAR --imu FILE or "
           "--pressure "
           "FILE";
  }
  return std::string("begins with bytes of no format that is known; ") + kWhatIsRead;
}

std::string why_folder(const fs::path& folder) {
  constexpr std::size_t kMostNames = 5;
  std::error_code error;
  std::size_t files = 0;
  std::string names;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (files++ < kMostNames) names += (names.empty() ? "" : ", ") + name_of(entry.path());
  }
  if (error) return "cannot be read: " + error.message();
  if (files == 0) return "is an empty folder";
  return "is neither a recording (no recording.toml) nor a folder of a bag or of scans: it holds " + names +
         (files > kMostNames ? " …" : "") + "; " + kWhatIsRead;
}

}  // namespace

std::string why_unreadable(const fs::path& source) {
  std::error_code error;
  const std::string name = source.string() + ": ";
  if (!fs::exists(source, error)) return name + "no such file or folder";
  return name + (fs::is_directory(source, error) ? why_folder(source) : why_file(source));
}

}  // namespace isobar::tools
