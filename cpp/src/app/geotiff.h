#pragma once

// Terrain from GeoTIFF, as far as the demo needs it: one band of whole or float32 heights in strips, north
// up, in longitude and latitude on WGS84 (EPSG:4326). The Python package reads everything else, through GDAL.

#include <filesystem>

#include "decalgl/geo/geographic_raster.h"

namespace decalgl {

/// Throws Error(file) where the file is missing or damaged, Error(crs) where it lies in another coordinate
/// system, Error(unsupported) for other layouts, and Error(memory) where it declares more samples than it
/// may.
GeographicRaster read_geotiff(const std::filesystem::path& path);

}  // namespace decalgl
