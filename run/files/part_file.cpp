// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/part_file.hpp"

#include <string>
#include <system_error>

#include "core/errors.hpp"

namespace isobar::files {

namespace {

std::filesystem::path written_first(const std::filesystem::path& file) {
  std::error_code error;
  const bool other = std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
  return other ? file : std::filesystem::path(file.string() + ".part");
}

}  // namespace

PartFile::PartFile(const std::filesystem::path& file)
    : path_(file), written_(written_first(file)), file_(written_) {}

void PartFile::abandon() {
  file_.close();
  std::error_code error;
  if (written_ != path_) std::filesystem::remove(written_, error);
}

void PartFile::close() {
  file_.sync();
  file_.close();
  if (written_ == path_) return;
  std::error_code error;
  std::filesystem::rename(written_, path_, error);
  if (error) throw ServiceError(path_.string() + ": cannot be replaced: " + error.message());
}

}  // namespace isobar::files
