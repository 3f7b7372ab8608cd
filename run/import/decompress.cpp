// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace isobar::imports {
namespace {

constexpr std::size_t kStepBytes = std::size_t{1} << 20U;
constexpr const char* kTooLong = "decompressed data exceeds the size that its header states";
constexpr const char* kEndsEarly = "compressed data ends early";

/// Room behind `used` bytes, at most up to one byte more than allowed: that byte tells that there is too much.
std::span<std::uint8_t> room(std::vector<std::uint8_t>& to, std::size_t used, std::uint64_t most) {
  const std::uint64_t wanted = std::min<std::uint64_t>(used + kStepBytes, most + 1);
  to.resize(std::max<std::uint64_t>(wanted, used));
  return std::span(to).subspan(used);
}

const char* lz4(std::span<const std::uint8_t> from, std::uint64_t most, std::vector<std::uint8_t>& to) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0U) return "lz4: no memory";
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  std::size_t used = 0;
  std::size_t hint = 1;
  while (!from.empty()) {
    const std::span<std::uint8_t> free = room(to, used, most);
    std::size_t out = free.size();
    std::size_t in = from.size();
    hint = LZ4F_decompress(context.get(), free.data(), &out, from.data(), &in, nullptr);
    used += out;
    from = from.subspan(in);
    if (LZ4F_isError(hint) != 0U || used > most || (in == 0 && out == 0)) {
      to.resize(std::min<std::uint64_t>(used, most));
      return used > most ? kTooLong : "damaged lz4 data";
    }
  }
  to.resize(used);
  return hint == 0 ? nullptr : kEndsEarly;
}

const char* zstd(std::span<const std::uint8_t> from, std::uint64_t most, std::vector<std::uint8_t>& to) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  if (stream == nullptr) return "zstd: no memory";
  ZSTD_inBuffer in{from.data(), from.size(), 0};
  std::size_t used = 0;
  std::size_t hint = 1;
  bool full = true;  // the last call filled its room: more may wait inside
  while (in.pos < in.size || full) {
    const std::span<std::uint8_t> free = room(to, used, most);
    ZSTD_outBuffer out{free.data(), free.size(), 0};
    const std::size_t before = in.pos;
    hint = ZSTD_decompressStream(stream.get(), &out, &in);
    used += out.pos;
    full = out.pos == out.size && out.size > 0;
    if (ZSTD_isError(hint) != 0U || used > most) {
      to.resize(std::min<std::uint64_t>(used, most));
      return used > most ? kTooLong : "damaged zstd data";
    }
    if (hint == 0 && in.pos == in.size) break;
    if (out.pos == 0 && in.pos == before) break;
  }
  to.resize(used);
  return hint == 0 ? nullptr : kEndsEarly;
}

const char* bz2(std::span<const std::uint8_t> from, std::uint64_t most, std::vector<std::uint8_t>& to) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return "bz2: no memory";
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream, &BZ2_bzDecompressEnd);
  // The library does not write to its input.
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(from.data()));
  stream.avail_in = static_cast<unsigned>(from.size());
  std::size_t used = 0;
  int state = BZ_OK;
  while (state == BZ_OK) {
    const std::span<std::uint8_t> free = room(to, used, most);
    stream.next_out = reinterpret_cast<char*>(free.data());
    stream.avail_out = static_cast<unsigned>(free.size());
    state = BZ2_bzDecompress(&stream);
    const std::size_t out = free.size() - stream.avail_out;
    used += out;
    if (used > most || (state == BZ_OK && out == 0 && stream.avail_in == 0)) break;
  }
  to.resize(std::min<std::uint64_t>(used, most));
  if (used > most) return kTooLong;
  if (state == BZ_STREAM_END) return nullptr;
  return state == BZ_OK ? kEndsEarly : "damaged bz2 data";
}

}  // namespace

const char* decompress(std::string_view method, std::span<const std::uint8_t> from, std::uint64_t most,
                       std::vector<std::uint8_t>& to) {
  to.clear();
  if (method.empty() || method == "none") {
    if (from.size() > most) return kTooLong;
    to.assign(from.begin(), from.end());
    return nullptr;
  }
  if (from.empty()) return kEndsEarly;
  if (method == "lz4") return lz4(from, most, to);
  if (method == "zstd") return zstd(from, most, to);
  if (method == "bz2") return bz2(from, most, to);
  return "is compressed by a method that is not read";
}

}  // namespace isobar::imports
