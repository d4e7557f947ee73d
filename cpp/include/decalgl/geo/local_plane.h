#pragma once

// A metric plane around a place on the globe: transverse Mercator on the WGS84 ellipsoid, true to scale on
// the meridian through its centre and within 1e-4 of it up to 90 km away.
//
//     y north          the same plane as PROJ's +proj=tmerc +lat_0=... +lon_0=... +k=1 +datum=WGS84,
//     ^                so positions agree with pyproj's to a micrometre
//     |
//     +--> x east      centre at (0, 0)

#include <glm/vec2.hpp>
#include <memory>

#include "decalgl/core/span.h"

namespace decalgl {

class LocalPlane {
public:
    /// The plane with its origin at a longitude and latitude in degrees.
    /// Throws Error(crs) where that is no place on the globe.
    LocalPlane(double longitude, double latitude);

    /// The plane around a place, with the origin rounded to 1e-4 degrees and to longitudes of -180 to 180.
    static LocalPlane around(double longitude, double latitude);

    double longitude() const { return longitude_; }
    double latitude() const { return latitude_; }

    /// From (longitude, latitude) in degrees to (x, y) in metres; NaN for a latitude beyond a pole and for
    /// what is not finite.
    glm::dvec2 forward(glm::dvec2 degrees) const;
    /// From (x, y) in metres to (longitude, latitude) in degrees, the longitude within 180 of the centre's.
    glm::dvec2 inverse(glm::dvec2 metres) const;

    /// Many points at once, stored as pairs; `from` and `to` have the same, even size (else Error(input)) and
    /// may be the same array. The values are those of the functions above. `threads` 0 takes all cores.
    void forward(Span<const double> from, Span<double> to, unsigned threads = 0) const;
    void inverse(Span<const double> from, Span<double> to, unsigned threads = 0) const;

private:
    struct Projection;

    double longitude_;
    double latitude_;
    std::shared_ptr<const Projection> projection_;
};

}  // namespace decalgl
