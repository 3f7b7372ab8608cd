// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/point_file.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "run/files/las_writer.hpp"
#include "run/files/pcd_writer.hpp"
#include "run/files/ply_writer.hpp"

namespace isobar::files {

namespace {

template <typename Writer>
class FileOf : public PointFile {
 public:
  template <typename... Arguments>
  explicit FileOf(Arguments&&... arguments) : writer_(std::forward<Arguments>(arguments)...) {}
  void add(const MapPoint& point) override { writer_.add(point); }
  void close() override { writer_.close(); }

 private:
  Writer writer_;
};

}  // namespace

std::unique_ptr<PointFile> open_point_file(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".ply") return std::make_unique<FileOf<PlyWriter>>(file, PlyFields::kNormalIntensity);
  if (ending == ".pcd") return std::make_unique<FileOf<PcdWriter>>(file);
  if (ending == ".las") return std::make_unique<FileOf<LasWriter>>(file);
  throw UsageError(file.string() + ": files of points end with one of " + kPointFileEndings);
}

}  // namespace isobar::files
