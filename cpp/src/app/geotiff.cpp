#include "app/geotiff.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "decalgl/core/error.h"
#include "decalgl/core/span.h"

namespace decalgl {
namespace {

// Tags and keys of OGC GeoTIFF 1.1, and GDAL's mark of missing samples.
constexpr std::uint32_t model_pixel_scale = 33550;
constexpr std::uint32_t model_tiepoint = 33922;
constexpr std::uint32_t model_transformation = 34264;
constexpr std::uint32_t geo_key_directory = 34735;
constexpr std::uint32_t gdal_nodata = 42113;
constexpr std::uint16_t model_type_key = 1024;
constexpr std::uint16_t raster_type_key = 1025;
constexpr std::uint16_t geographic_type_key = 2048;
constexpr std::uint16_t geographic_model = 2;
constexpr std::uint16_t point_samples = 2;
constexpr std::uint16_t wgs84 = 4326;

constexpr std::uint64_t most_samples = std::uint64_t{16384} * 16384;
/// Deflate cannot shrink data by more than about 1030; a file that claims far more is nearly empty.
constexpr std::uint64_t most_shrinking = 2000;
constexpr tmsize_t most_memory = tmsize_t{512} << 20;  // that libtiff may take at once
constexpr std::uint64_t small_bytes = std::uint64_t{64} << 20;

struct CloseTiff {
    void operator()(TIFF* file) const { TIFFClose(file); }
};

class GeoTiff {
public:
    explicit GeoTiff(const std::filesystem::path& path) : name_(path.string()) {
        std::error_code failure;
        stored_bytes_ = std::filesystem::file_size(path, failure);
        if (failure) {
            throw Error(ErrorKind::file,
                        fmt::format("There is no file '{}' to read a terrain from. Check the path.", name_));
        }
        const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                       TIFFOpenOptionsFree);
        // The file's own handlers: libtiff's default ones write to standard error.
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &keep_message, &message_);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), &drop_message, nullptr);
        TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), most_memory);
        file_.reset(TIFFOpenExt(name_.c_str(), "r", options.get()));
        if (!file_) {
            refuse("it cannot be opened");
        }
    }

    GeographicRaster read() {
        GeographicRaster raster;
        check_layout(raster);
        place(raster);
        read_heights(raster);
        return raster;
    }

private:
    static int keep_message(TIFF*, void* text, const char*, const char* format, va_list arguments) {
        char line[256];
        std::vsnprintf(line, sizeof line, format, arguments);
        *static_cast<std::string*>(text) = line;
        return 1;
    }

    static int drop_message(TIFF*, void*, const char*, const char*, va_list) { return 1; }

    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(ErrorKind::file,
                    fmt::format("'{}' is not a whole GeoTIFF: {}{}{}. Fetch or write it again.", name_, what,
                                message_.empty() ? "" : "; libtiff says: ", message_));
    }

    [[noreturn]] void refuse_layout(const std::string& what) const {
        throw Error(
            ErrorKind::unsupported,
            fmt::format(
                "'{}' {}, which this program does not read. Rewrite it with gdal_translate as one band "
                "of Int16 or Float32 in strips.",
                name_, what));
    }

    template <typename Value>
    Value field(std::uint32_t tag, Value fallback) const {
        Value value = fallback;
        TIFFGetFieldDefaulted(file_.get(), tag, &value);
        return value;
    }

    /// The values of a tag that libtiff does not know by itself; empty where it is missing or of another
    /// type.
    template <typename Value>
    Span<const Value> values(std::uint32_t tag, TIFFDataType type) const {
        const TIFFField* known = TIFFFindField(file_.get(), tag, TIFF_ANY);
        std::uint32_t count = 0;
        const void* data = nullptr;
        if (known == nullptr || TIFFFieldDataType(known) != type || TIFFFieldPassCount(known) == 0 ||
            TIFFFieldReadCount(known) != TIFF_VARIABLE2 ||
            TIFFGetField(file_.get(), tag, &count, &data) == 0 || data == nullptr) {
            return {};
        }
        return {static_cast<const Value*>(data), count};
    }

    void check_layout(GeographicRaster& raster) {
        const auto columns = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
        const auto rows = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
        bits_ = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 0);
        format_ = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        if (columns == 0 || rows == 0) {
            refuse("it has no samples");
        }
        const std::uint64_t samples = std::uint64_t{columns} * rows;
        const std::uint64_t bytes = samples * bits_ / 8;
        if (samples > most_samples || bytes > std::max(small_bytes, most_shrinking * stored_bytes_)) {
            throw Error(
                ErrorKind::memory,
                fmt::format("'{}' declares {} x {} samples, more than it may or can hold. Cut it to the area "
                            "of interest with gdal_translate -projwin.",
                            name_, rows, columns));
        }
        if (TIFFIsTiled(file_.get()) != 0) {
            refuse_layout("is stored in tiles");
        }
        if (field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1) != 1) {
            refuse_layout("has several bands");
        }
        raster.rows = static_cast<std::int32_t>(rows);
        raster.columns = static_cast<std::int32_t>(columns);
    }

    /// The value of a geo key that is stored in the directory itself.
    std::optional<std::uint16_t> geo_key(std::uint16_t key) const {
        const Span<const std::uint16_t> directory = values<std::uint16_t>(geo_key_directory, TIFF_SHORT);
        for (std::size_t entry = 4; entry + 4 <= directory.size(); entry += 4) {
            if (directory[entry] == key && directory[entry + 1] == 0) {
                return directory[entry + 3];
            }
        }
        return std::nullopt;
    }

    void place(GeographicRaster& raster) const {
        if (geo_key(model_type_key) != geographic_model || geo_key(geographic_type_key) != wgs84) {
            throw Error(ErrorKind::crs,
                        fmt::format("'{}' does not lie in longitude and latitude on WGS84, which is all "
                                    "that this program reads. Warp it: gdalwarp -t_srs EPSG:4326.",
                                    name_));
        }
        const Span<const double> scale = values<double>(model_pixel_scale, TIFF_DOUBLE);
        const Span<const double> tie = values<double>(model_tiepoint, TIFF_DOUBLE);
        if (scale.size() < 2 || tie.size() != 6 ||
            !values<double>(model_transformation, TIFF_DOUBLE).empty()) {
            refuse_layout("is not placed by a scale and one tie point");
        }
        // Raster positions count from the corner of sample (0, 0), or from its centre for point samples.
        const double half = geo_key(raster_type_key) == point_samples ? 0.0 : 0.5;
        raster.longitude_step = scale[0];
        raster.latitude_step = -scale[1];
        raster.longitude = tie[3] + (half - tie[0]) * scale[0];
        raster.latitude = tie[4] - (half - tie[1]) * scale[1];
    }

    void read_heights(GeographicRaster& raster) {
        if (format_ == SAMPLEFORMAT_INT && bits_ == 16) {
            read_samples<std::int16_t>(raster);
        } else if (format_ == SAMPLEFORMAT_UINT && bits_ == 16) {
            read_samples<std::uint16_t>(raster);
        } else if (format_ == SAMPLEFORMAT_INT && bits_ == 32) {
            read_samples<std::int32_t>(raster);
        } else if (format_ == SAMPLEFORMAT_IEEEFP && bits_ == 32) {
            read_samples<float>(raster);
        } else {
            refuse_layout(fmt::format("holds samples of {} bits in format {}", bits_, format_));
        }
    }

    template <typename Sample>
    void read_samples(GeographicRaster& raster) {
        const auto columns = static_cast<std::size_t>(raster.columns);
        std::vector<Sample> line(columns);
        if (static_cast<std::size_t>(TIFFScanlineSize64(file_.get())) != columns * sizeof(Sample)) {
            refuse("its rows are of another length than it says");
        }
        const double missing = nodata();
        raster.heights.reserve(columns * static_cast<std::size_t>(raster.rows));
        for (std::int32_t row = 0; row < raster.rows; ++row) {
            if (TIFFReadScanline(file_.get(), line.data(), static_cast<std::uint32_t>(row), 0) < 0) {
                refuse(fmt::format("row {} cannot be read", row));
            }
            for (const Sample sample : line) {
                raster.heights.push_back(static_cast<double>(sample) == missing
                                             ? std::numeric_limits<float>::quiet_NaN()
                                             : static_cast<float>(sample));
            }
        }
    }

    /// The value that marks missing samples; NaN, which equals nothing, where the file names none.
    double nodata() const {
        const Span<const char> text = values<char>(gdal_nodata, TIFF_ASCII);
        const std::string number(text.begin(), text.end());
        char* end = nullptr;
        const double value = std::strtod(number.c_str(), &end);
        return end == number.c_str() ? std::numeric_limits<double>::quiet_NaN() : value;
    }

    std::string name_;
    std::string message_;  // libtiff's last one
    std::uint64_t stored_bytes_ = 0;
    std::unique_ptr<TIFF, CloseTiff> file_;
    std::uint16_t bits_ = 0;
    std::uint16_t format_ = 0;
};

}  // namespace

GeographicRaster read_geotiff(const std::filesystem::path& path) {
    return GeoTiff(path).read();
}

}  // namespace decalgl
