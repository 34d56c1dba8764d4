// SPDX-License-Identifier: MIT
#include <zlib.h>

#include "packed.hpp"

namespace ductile::replay {

namespace {

std::string zipped(const std::string& bytes) {
    z_stream stream{};
    constexpr int gzip = 15 + 16, memory = 9;
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, gzip, memory, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
        throw Error("zlib could not be started");
    }
    std::string result(deflateBound(&stream, uLong(bytes.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = uInt(result.size());
    const int end = deflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    if (end != Z_STREAM_END) throw Error("zlib could not pack the recording");
    return result;
}

} // namespace

std::string pack(const Recording& recording) { return zipped(laid_down(recording)); }

} // namespace ductile::replay
