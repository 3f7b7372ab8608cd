// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/csv_writer.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>

#include "core/errors.hpp"

namespace isobar::recording {

TextFile::TextFile(const std::filesystem::path& file)
    : name_(file.string()), file_(std::fopen(file.c_str(), "wb")) {
  if (file_ == nullptr) {
    throw DataError(name_ + ": cannot be written: " + std::strerror(errno));
  }
}

void TextFile::close() {
  if (file_ == nullptr) {
    return;
  }
  if (std::fflush(file_.get()) != 0 && error_ == 0) {
    error_ = errno;
  }
  file_.reset();
  if (error_ != 0) {
    throw DataError(name_ + ": could not be written completely: " + std::strerror(error_));
  }
}

void TextFile::write(std::string_view text) {
  if (file_ == nullptr) {
    throw DataError(name_ + ": cannot be written: it is closed");
  }
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() && error_ == 0) {
    error_ = errno;
  }
}

void CsvRow::separate() {
  if (used_ > 0) {
    text_[used_++] = ',';
  }
}

CsvRow& CsvRow::add(double value) {
  separate();
  used_ = static_cast<std::size_t>(std::to_chars(text_ + used_, text_ + kCapacity - 2, value).ptr - text_);
  return *this;
}

CsvRow& CsvRow::add(std::int64_t value) {
  separate();
  used_ = static_cast<std::size_t>(std::to_chars(text_ + used_, text_ + kCapacity - 2, value).ptr - text_);
  return *this;
}

std::string_view CsvRow::finish() {
  text_[used_++] = '\n';
  return {text_, used_};
}

}  // namespace isobar::recording
