#pragma once

// A terrain in degrees, and how it comes onto a metric plane.
//
//     target (row, column) ─▶ x, y ─▶ longitude, latitude ─▶ source (row, column) ─▶ four samples
//
// The plane's grid covers the positions of all samples, as fine as the source is at its centre. Each of its
// samples is moved back exactly (nothing is approximated between them) and interpolated bilinearly; it is a
// hole where any sample that carries weight is one, so holes never shrink.

#include <cstdint>
#include <vector>

#include "decalgl/geo/local_plane.h"
#include "decalgl/terrain/heightfield.h"

namespace decalgl {

struct GeographicRaster {
    /// In metres, NaN where there is none: heights[row * columns + column].
    std::vector<float> heights;
    std::int32_t rows = 0;
    std::int32_t columns = 0;
    /// Sample (row, column) lies at (longitude + column * longitude_step, latitude + row * latitude_step),
    /// degrees; the latitude step is below 0 where row 0 is the northernmost.
    double longitude = 0.0;
    double latitude = 0.0;
    double longitude_step = 0.0;
    double latitude_step = 0.0;
};

struct WarpLimits {
    std::uint64_t max_samples = std::uint64_t{16384} * 16384;  ///< that the plane's grid may have
    unsigned threads = 0;                                      ///< 0: all cores
};

/// The plane around the raster's centre. Throws Error(crs) where that is no place on the globe.
LocalPlane plane_around(const GeographicRaster& raster);

/// The raster's heights on the plane. Throws Error(input) for a raster of fewer than 2 x 2 samples or whose
/// numbers do not fit together, Error(crs) where it does not fit on the plane (it spans a large part of the
/// globe), and Error(memory) past max_samples.
Heightfield warp_to_plane(const GeographicRaster& raster, const LocalPlane& plane,
                          const WarpLimits& limits = {});

}  // namespace decalgl
