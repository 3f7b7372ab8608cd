// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/file_bytes.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/errors.hpp"

namespace isobar::imports {

FileBytes::FileBytes(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code error;
  // A FIFO or a device could block or never end.
  if (!std::filesystem::is_regular_file(file, error)) {
    throw DataError(name_ + (std::filesystem::exists(file, error) ? ": is no file" : ": no such file"));
  }
  file_.reset(std::fopen(name_.c_str(), "rbe"));
  if (file_ == nullptr) throw DataError(name_ + ": cannot be read: " + std::strerror(errno));
  size_ = std::filesystem::file_size(file, error);
  if (error) throw DataError(name_ + ": cannot be read: " + error.message());
}

bool FileBytes::read(std::span<std::uint8_t> to) {
  if (to.size() > left()) return false;
  const std::size_t got = std::fread(to.data(), 1, to.size(), file_.get());
  position_ += got;
  return got == to.size();
}

bool FileBytes::read(std::uint64_t size, std::vector<std::uint8_t>& to) {
  if (size > left() || size > kMostRecordBytes) return false;
  to.resize(size);
  return read(std::span(to));
}

bool FileBytes::skip(std::uint64_t size) {
  if (size > left()) return false;
  position_ += size;
  return std::fseek(file_.get(), static_cast<long>(position_), SEEK_SET) == 0;
}

std::string FileBytes::place(std::uint64_t at) const { return name_ + ": byte " + std::to_string(at) + ": "; }

std::string head_of(const std::filesystem::path& file, std::size_t bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  std::ifstream in(file, std::ios::binary);
  std::string head(bytes, '\0');
  in.read(head.data(), static_cast<std::streamsize>(bytes));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
}

}  // namespace isobar::imports
