// What a view wants of each vertex, on the CPU: the tolerance in its region (detail.glsl has the same for pixels), and
// whether the region is in the picture.
//
//     eye ------------.___________        A region that lies beyond one of the planes through the picture's borders
//         \ ___________ picture   |       is not seen, and wants nothing. What is below it lies in it, and the base in
//          \_____________________ |       its place does too. So nothing that is seen changes.
#pragma once

#include <array>
#include <vector>

#include "decalgl/technique/loops_detail.h"
#include "decalgl/technique/technique.h"
#include "technique/loops/active_arcs.h"

namespace decalgl::loops {

// The camera of a view, out of what all passes are told of it.
DetailEye detail_eye_of(const View& view);

// Where normal * place + offset is below 0, nothing is seen. Metres from the lattice's origin; heights as they are.
struct SightPlane {
    std::array<double, 3> normal;
    double on_map;  // the normal's length there
    double offset;

    double at(const std::array<double, 3>& place) const {
        return normal[0] * place[0] + normal[1] * place[1] + normal[2] * place[2] + offset;
    }
};

// What the whole picture of a view sees, and two pixels around it.
class Sight {
public:
    Sight(const View& view, const Lattice& lattice, const GroundRange& heights);

    const std::vector<SightPlane>& planes() const { return planes_; }
    // Of the map; empty where no ground is seen.
    const LatticeBox& box() const { return box_; }
    bool operator==(const Sight& other) const;

private:
    void find_box(const std::array<double, 3>& eye, const Lattice& lattice, const GroundRange& heights);

    std::vector<SightPlane> planes_;
    LatticeBox box_;
};

class ViewDetail {
public:
    ViewDetail(const LoopsDetail& detail, const DetailEye& eye, const Sight& sight, const Lattice& lattice,
               const GroundRange& heights);

    // `reach`: how far what is drawn reaches beyond its vertices, metres. `is_inside`: as all above is in the picture.
    Verdict judge(const Activation& activation, double reach, bool is_inside) const;

private:
    double tolerance(double x, double y, double radius, double low, double high) const;

    LoopsDetail detail_;
    DetailEye eye_;  // from the lattice's origin
    const Sight& sight_;
    double quantum_, length_, lowest_, height_step_;
    double forward_on_map_, screen_slope_, screen_least_;
};

}  // namespace decalgl::loops
