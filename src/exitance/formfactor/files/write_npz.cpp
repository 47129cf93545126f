// SPDX-License-Identifier: Apache-2.0
// .npz: a zip archive of .npy arrays (NumPy Enhancement Proposal 1), named as
// scipy.sparse.load_npz expects a CSR matrix.
#include <fmt/format.h>
#include <minizip/zip.h>

#include <bit>
#include <cstring>

#include "exitance/formfactor/files/write_form_factors.h"
#include "exitance/run/error.h"

namespace exitance {

namespace {

using Entry = FormFactorMatrix::Entry;

// minizip's file functions over a stream; its handle is the stream itself.
std::ostream& stream_of(voidpf handle) {
    return *static_cast<std::ostream*>(handle);
}
voidpf ZCALLBACK open_stream(voidpf opaque, const void*, int) {
    return opaque;
}
uLong ZCALLBACK read_nothing(voidpf, voidpf, void*, uLong) {
    return 0;
}
uLong ZCALLBACK write_stream(voidpf, voidpf handle, const void* bytes, uLong size) {
    stream_of(handle).write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    return stream_of(handle) ? size : 0;
}
ZPOS64_T ZCALLBACK tell_stream(voidpf, voidpf handle) {
    return static_cast<ZPOS64_T>(stream_of(handle).tellp());
}
long ZCALLBACK seek_stream(voidpf, voidpf handle, ZPOS64_T offset, int origin) {
    const auto from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? std::ios::cur
                      : origin == ZLIB_FILEFUNC_SEEK_END ? std::ios::end
                                                         : std::ios::beg;
    stream_of(handle).seekp(static_cast<std::streamoff>(offset), from);
    return stream_of(handle) ? 0 : -1;
}
int ZCALLBACK close_nothing(voidpf, voidpf) {
    return 0;
}
int ZCALLBACK stream_error(voidpf, voidpf handle) {
    return stream_of(handle) ? 0 : 1;
}

class Archive {
  public:
    explicit Archive(std::ostream& out) {
        zlib_filefunc64_def calls{open_stream, read_nothing,  write_stream, tell_stream,
                                  seek_stream, close_nothing, stream_error, &out};
        zip_ = zipOpen2_64("form factors", APPEND_STATUS_CREATE, nullptr, &calls);
        check(zip_ != nullptr);
    }
    ~Archive() {
        if (zip_) zipClose(zip_, nullptr);
    }
    Archive(const Archive&) = delete;
    Archive& operator=(const Archive&) = delete;

    // Begins `name`.npy of the type and shape, "(3,)"; put() what it holds.
    void begin(const std::string& name, const std::string& type, const std::string& shape) {
        zip_fileinfo facts{};
        facts.tmz_date.tm_year = 1980;  // the same bytes whenever it is written
        facts.tmz_date.tm_mday = 1;
        check(zipOpenNewFileInZip64(zip_, (name + ".npy").c_str(), &facts, nullptr, 0, nullptr, 0,
                                    nullptr, Z_DEFLATED, Z_BEST_SPEED, 1) == ZIP_OK);
        std::string header =
            fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
        // Magic, version, length and header fill a multiple of 64 bytes that ends a line.
        header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 10 - 1, ' ');
        header += '\n';
        const auto length = static_cast<unsigned>(header.size());
        const unsigned char begin[10] = {0x93,
                                         'N',
                                         'U',
                                         'M',
                                         'P',
                                         'Y',
                                         1,
                                         0,
                                         static_cast<unsigned char>(length & 255U),
                                         static_cast<unsigned char>(length >> 8)};
        put(begin, sizeof begin);
        put(header.data(), header.size());
    }
    void put(const void* bytes, std::size_t size) {
        check(size == 0 || zipWriteInFileInZip(zip_, bytes, static_cast<unsigned>(size)) == ZIP_OK);
    }
    template <class T>
    void put(const std::vector<T>& values) {
        put(values.data(), values.size() * sizeof(T));
    }
    void end() { check(zipCloseFileInZip(zip_) == ZIP_OK); }
    void close() {
        const int result = zipClose(zip_, nullptr);
        zip_ = nullptr;
        check(result == ZIP_OK);
    }

  private:
    static void check(bool fine) {
        if (!fine)
            throw Error(Fault::could_not_finish,
                        "the .npz archive could not be written: disk full, or not a regular file");
    }
    zipFile zip_ = nullptr;
};

std::u32string decoded(const std::string& text) {
    std::u32string out;
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t k) {
            return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U;
        };
        const unsigned first = byte(i);
        const std::size_t length = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
        char32_t c = length == 1 ? first : first & (0xffU >> (length + 1));
        for (std::size_t k = 1; k < length; ++k) c = c << 6 | (byte(i + k) & 0x3fU);
        out.push_back(c);
        i += length;
    }
    return out;
}

void put_names(Archive& archive, std::span<const ExchangeSurface> surfaces) {
    std::vector<std::u32string> names;
    std::size_t longest = 1;
    for (const ExchangeSurface& surface : surfaces) {
        names.push_back(decoded(surface.name));
        longest = std::max(longest, names.back().size());
    }
    archive.begin("names", fmt::format("<U{}", longest), fmt::format("({},)", names.size()));
    for (std::u32string& name : names) {
        name.resize(longest, U'\0');
        archive.put(name.data(), longest * sizeof(char32_t));
    }
    archive.end();
}

}  // namespace

void write_npz(std::ostream& out, const FormFactorResult& result) {
    static_assert(std::endian::native == std::endian::little);
    const FormFactorMatrix& F = result.F;
    std::vector<std::int64_t> starts{0};
    F.for_rows([&](std::size_t, std::span<const Entry> entries) {
        starts.push_back(starts.back() + static_cast<std::int64_t>(entries.size()));
    });
    const std::string count = fmt::format("({},)", starts.back());
    const std::string rows = fmt::format("({},)", F.rows());
    Archive archive(out);
    archive.begin("indices", "<i8", count);
    F.for_rows([&](std::size_t, std::span<const Entry> entries) {
        std::vector<std::int64_t> columns;
        for (const Entry& e : entries) columns.push_back(e.column);
        archive.put(columns);
    });
    archive.end();
    archive.begin("indptr", "<i8", fmt::format("({},)", starts.size()));
    archive.put(starts);
    archive.end();
    archive.begin("format", "|S3", "()");
    archive.put("csr", 3);
    archive.end();
    const std::vector<std::int64_t> shape(2, static_cast<std::int64_t>(F.rows()));
    archive.begin("shape", "<i8", "(2,)");
    archive.put(shape);
    archive.end();
    archive.begin("data", "<f4", count);
    F.for_rows([&](std::size_t, std::span<const Entry> entries) {
        std::vector<float> values;
        for (const Entry& e : entries) values.push_back(e.value);
        archive.put(values);
    });
    archive.end();
    std::vector<double> emissivities;
    for (const ExchangeSurface& surface : result.surfaces)
        emissivities.push_back(surface.emissivity);
    archive.begin("areas", "<f8", rows);
    archive.put(F.areas());
    archive.end();
    archive.begin("emissivities", "<f8", rows);
    archive.put(emissivities);
    archive.end();
    put_names(archive, result.surfaces);
    archive.close();
}

}  // namespace exitance
