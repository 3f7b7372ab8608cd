// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/packed_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/scratch_folder.hpp"
#include "run/text/gzip_file.hpp"

namespace isobar::imports {
namespace {

constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";
constexpr std::string_view kGzipMagic = "\x1F\x8B";

/// Takes decompressed bytes; false: no more.
using Sink = std::function<bool(const char* bytes, std::size_t size)>;

/// @return why it ended early; empty: it did not
std::string unpack_gzip(const std::filesystem::path& file, const Sink& sink) {
  text::GzipFile packed(file);
  std::vector<char> part(std::size_t{1} << 20U);
  while (const std::size_t size = packed.read(part.data(), part.size())) {
    if (!sink(part.data(), size)) return {};
  }
  return packed.damage();
}

std::string unpack_zstd(const std::filesystem::path& file, const Sink& sink) {
  FileBytes packed(file);
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  if (stream == nullptr) throw DataError(packed.name() + ": zstd: no memory");
  std::vector<std::uint8_t> from;
  std::vector<char> part(ZSTD_DStreamOutSize());
  std::size_t hint = 1;
  while (packed.left() > 0) {
    if (!packed.read(std::min<std::uint64_t>(packed.left(), ZSTD_DStreamInSize()), from))
      return packed.place(packed.position()) + "cannot be read";
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    for (bool full = false; in.pos < in.size || full;) {
      ZSTD_outBuffer out{part.data(), part.size(), 0};
      hint = ZSTD_decompressStream(stream.get(), &out, &in);
      if (ZSTD_isError(hint) != 0U) return packed.place(packed.position()) + "damaged zstd data before it";
      if (out.pos > 0 && !sink(part.data(), out.pos)) return {};
      full = out.pos == out.size;
      if (in.pos == in.size && (hint == 0 || out.pos == 0)) break;
    }
  }
  return hint == 0 ? std::string() : packed.place(packed.position()) + "the compressed data end early";
}

std::string unpack(const std::filesystem::path& file, const Sink& sink) {
  return head_of(file, kZstdMagic.size()) == kZstdMagic ? unpack_zstd(file, sink) : unpack_gzip(file, sink);
}

/// The container that came out of a packed file, which goes with the object.
class UnpackedStream : public MessageStream {
 public:
  explicit UnpackedStream(const std::filesystem::path& file)
      : packed_(file.string()), unpacked_(scratch_.path() / file.stem()) {
    std::string early = write();
    if (!early.empty()) damage_.add([&] { return std::move(early); });
    stream_ = open_unpacked();
  }

  bool next(Message& message) override {
    if (stream_->next(message)) return true;
    for (; seen_ < stream_->damage().count; ++seen_) {
      damage_.add([this] { return about_source(stream_->damage().first_message); });
    }
    return false;
  }
  [[nodiscard]] const std::vector<Channel>& channels() const override { return stream_->channels(); }
  [[nodiscard]] const recording::Tally& damage() const override { return damage_; }
  [[nodiscard]] double progress() const override { return stream_->progress(); }
  [[nodiscard]] std::string container() const override { return stream_->container() + ", decompressed"; }

 private:
  std::string write() {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> to(std::fopen(unpacked_.c_str(), "wbe"),
                                                             &std::fclose);
    const auto refuse = [&] {
      throw DataError(packed_ + ": cannot be decompressed into " + scratch_.path().string() + ": " +
                      std::strerror(errno) + "; TMPDIR names a folder with room");
    };
    if (to == nullptr) refuse();
    std::string early = unpack(packed_, [&](const char* bytes, std::size_t size) {
      if (std::fwrite(bytes, 1, size, to.get()) != size) refuse();
      return true;
    });
    if (std::fflush(to.get()) != 0) refuse();
    return early;
  }
  std::unique_ptr<MessageStream> open_unpacked() const {
    try {
      if (is_packed(unpacked_)) throw DataError(packed_ + ": is compressed more than once");
      return open_messages(unpacked_);
    } catch (const DataError& error) {
      throw DataError(about_source(error.what()) +
                      (damage_.count > 0 ? "; " + damage_.first_message : std::string()));
    }
  }
  [[nodiscard]] std::string about_source(std::string text) const {
    const std::size_t at = text.find(unpacked_.string());
    return at == std::string::npos ? text
                                   : text.replace(at, unpacked_.string().size(), packed_ + ", decompressed");
  }

  ScratchFolder scratch_;
  std::string packed_;
  std::filesystem::path unpacked_;
  recording::Tally damage_;
  std::uint64_t seen_ = 0;  // of the damage of stream_
  std::unique_ptr<MessageStream> stream_;
};

}  // namespace

bool is_packed(const std::filesystem::path& file) {
  const std::string head = head_of(file, kZstdMagic.size());
  return head == kZstdMagic || head.starts_with(kGzipMagic);
}

std::string unpacked_head_of(const std::filesystem::path& file, std::size_t bytes) {
  if (!is_packed(file)) return head_of(file, bytes);
  std::string head;
  unpack(file, [&](const char* part, std::size_t size) {
    head.append(part, std::min(size, bytes - head.size()));
    return head.size() < bytes;
  });
  return head;
}

std::unique_ptr<MessageStream> open_packed(const std::filesystem::path& file) {
  return std::make_unique<UnpackedStream>(file);
}

}  // namespace isobar::imports
