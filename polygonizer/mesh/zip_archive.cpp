#include "polygonizer/mesh/zip_archive.hpp"

#include <minizip/zip.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

namespace deburr {

// A file in memory behind minizip's interface: minizip writes, and seeks back to fill in sizes that it did not know
// before.
struct ZipMemory {
    std::string bytes;
    std::size_t at = 0;

    void write(const char* from, std::size_t size) {
        bytes.resize(std::max(bytes.size(), at + size));
        std::copy_n(from, size, bytes.begin() + std::ptrdiff_t(at));
        at += size;
    }
};

namespace {

// The year counts from 1980, month and day from 1 [APPNOTE 4.4.6].
constexpr uLong first_day = 1u << 21 | 1u << 16;

ZipMemory& memory(void* p) { return *static_cast<ZipMemory*>(p); }

zlib_filefunc64_def functions_for(ZipMemory& target) {
    zlib_filefunc64_def f{};
    f.opaque = &target;
    f.zopen64_file = [](void* self, const void*, int) { return self; };
    f.zread_file = [](void*, void*, void*, uLong) { return uLong(0); };
    f.zwrite_file = [](void* self, void*, const void* from, uLong size) {
        try {
            memory(self).write(static_cast<const char*>(from), size);
        } catch (const std::bad_alloc&) {  // an exception must not pass through C functions
            return uLong(0);
        }
        return size;
    };
    f.ztell64_file = [](void* self, void*) { return ZPOS64_T(memory(self).at); };
    f.zseek64_file = [](void* self, void*, ZPOS64_T offset, int origin) {
        ZipMemory& m = memory(self);
        const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_SET   ? 0
                                 : origin == ZLIB_FILEFUNC_SEEK_CUR ? m.at
                                                                    : m.bytes.size();
        m.at = from + std::size_t(offset);
        return 0L;
    };
    f.zclose_file = [](void*, void*) { return 0; };
    f.zerror_file = [](void*, void*) { return 0; };
    return f;
}

}  // namespace

struct ZipArchive::Output {
    ZipMemory memory;
    zipFile file = nullptr;
    bool is_open = false;  // whether a file of the archive is open
};

ZipArchive::ZipArchive() : output_(std::make_unique<Output>()) {
    zlib_filefunc64_def functions = functions_for(output_->memory);
    output_->file = zipOpen2_64(nullptr, APPEND_STATUS_CREATE, nullptr, &functions);
    if (!output_->file) throw std::bad_alloc();
}

ZipArchive::~ZipArchive() {
    if (output_->file) zipClose(output_->file, nullptr);
}

void ZipArchive::end_file() {
    if (!output_->is_open) return;
    output_->is_open = false;
    const int result = zipCloseFileInZip(output_->file);
    if (result == ZIP_BADZIPFILE) throw std::length_error("a file of 4 GiB or more does not fit the archive");
    if (result != ZIP_OK) throw std::bad_alloc();
}

void ZipArchive::begin(const std::string& name) {
    end_file();
    zip_fileinfo info{};
    info.dosDate = first_day;
    if (zipOpenNewFileInZip(output_->file, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                            Z_DEFAULT_COMPRESSION) != ZIP_OK)
        throw std::bad_alloc();
    output_->is_open = true;
}

void ZipArchive::add(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::size_t size = std::min<std::size_t>(bytes.size(), std::numeric_limits<int>::max());
        if (zipWriteInFileInZip(output_->file, bytes.data(), unsigned(size)) != ZIP_OK) throw std::bad_alloc();
        bytes.remove_prefix(size);
    }
}

std::string ZipArchive::finish() {
    end_file();
    const int result = zipClose(output_->file, nullptr);
    output_->file = nullptr;
    if (result != ZIP_OK) throw std::bad_alloc();
    return std::move(output_->memory.bytes);
}

}  // namespace deburr
