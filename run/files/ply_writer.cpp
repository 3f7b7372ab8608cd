// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/ply_writer.hpp"

#include <array>
#include <bit>
#include <string>
#include <system_error>

#include "core/errors.hpp"

namespace isobar::files {

namespace {

static_assert(std::endian::native == std::endian::little, "floats are written in the machine's byte order");

/// Header of constant length, so that close() can overwrite it: a comment pads the count.
std::string ply_header(std::uint64_t count) {
  constexpr std::size_t kCountDigits = 20;  // of 2^64
  const std::string digits = std::to_string(count);
  return "ply\nformat binary_little_endian 1.0\ncomment isobar map, metres, z up\nelement vertex " + digits +
         "\ncomment " + std::string(kCountDigits - digits.size(), '.') +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nend_header\n";
}

/// A device or a pipe cannot be replaced.
std::filesystem::path written_first(const std::filesystem::path& file) {
  std::error_code error;
  const bool other = std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
  return other ? file : std::filesystem::path(file.string() + ".part");
}

}  // namespace

PlyWriter::PlyWriter(const std::filesystem::path& file)
    : path_(file), written_(written_first(file)), file_(written_) {
  file_.write(ply_header(0));
}

void PlyWriter::add(float x_m, float y_m, float z_m, float intensity) {
  const std::array<float, 4> vertex{x_m, y_m, z_m, intensity};
  file_.write(vertex.data(), sizeof(vertex));
  ++count_;
}

void PlyWriter::close() {
  if (!file_.is_open()) return;
  file_.seek(0);
  file_.write(ply_header(count_));
  file_.sync();
  file_.close();
  if (written_ == path_) return;
  std::error_code error;
  std::filesystem::rename(written_, path_, error);
  if (error) throw ServiceError(path_.string() + ": cannot be replaced: " + error.message());
}

}  // namespace isobar::files
