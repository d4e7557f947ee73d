// The contract between a frame and the ways to drape vectors over a terrain.
//
//     layers ─▶ preprocess ─▶ Prepared ─▶ upload ─▶ update(view) ─▶ draw, draw_ids
//               any thread    │ ▲ plain     GL thread from here on
//               no GL         ▼ │ arrays
//                        restyled, edited
//                              save │ ▲ open
//                                   ▼ │
//                                  a file
//
// Threads: `preprocess`, `open` and all of `Prepared` may run on any thread and touch no GL; Prepared is never
// changed once made, so several renderers may share it. Everything else is called on the thread that holds
// the context.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "decalgl/core/memory.h"
#include "decalgl/core/position_grid.h"
#include "decalgl/core/progress.h"
#include "decalgl/core/timing.h"
#include "decalgl/vector/decal.h"
#include "decalgl/vector/layer.h"
#include "decalgl/vector/layer_edit.h"
#include "decalgl/vector/layer_look.h"

namespace decalgl::gl {
class Framebuffer;
class Program;
class ProgramLibrary;
class Texture2D;
}  // namespace decalgl::gl

namespace decalgl {

class ArchiveReader;
class ArchiveWriter;
class Heightfield;
struct ViewBlock;

// How the structures of Zechmeister and Thöny are built and drawn; other techniques take no notice.
enum class SegmentOrder { importance, hilbert };  // in a cell: in draw order, or along a Hilbert curve
enum class Composition { order, nearest };        // lines: laid over each other, or the nearest one alone
enum class PassGrouping { layer, kind };  // a pass for each layer, or for neighbouring layers of one kind

struct BvhOptions {
    int cells = 500;        // along each side of the grid
    int leaf_capacity = 8;  // edges in a quad-tree's leaf, above its depth limit
    int depth_limit = 8;
    SegmentOrder segment_order = SegmentOrder::importance;
    Composition composition = Composition::order;
    PassGrouping passes = PassGrouping::layer;
};

// What a technique is given to prepare: a run of neighbouring layers of one scene, with equal TechniqueChoice.
struct TechniqueInput {
    Span<const Layer> layers;
    const Heightfield* terrain = nullptr;  // as it is drawn, and as long as what is prepared
    uint32_t first_layer = 0;              // place of layers[0] in the scene
    Bounds bounds;                         // of the terrain: nothing outside is ever seen
    PositionGrid positions;
    unsigned threads = 0;  // 0: all cores
    MemoryAccount memory;
    BvhOptions bvh;
};

struct PreparedCounts {
    uint64_t features = 0;
    uint64_t segments = 0;  // edges and line segments in the input
    uint64_t pieces = 0;    // what they became
    uint64_t bytes = 0;
    double quantum = 0.0;  // metres: how far a vertex may have moved
};

// A place on the terrain as a pixel sees it, on the plane of the triangle there.
struct SeenPoint {
    double x = 0.0;  // on the map, in the scene's coordinates
    double y = 0.0;
    double gradient_x = 0.0;  // metres of height a metre on the map
    double gradient_y = 0.0;
    double forward_z = -1.0;  // of the camera's unit view direction
    // An offset (x, y) on the map, dropped onto that plane, lies (x * east + y * north) / (1 + x * lean_x + y * lean_y)
    // pixels from the place on the screen.
    std::array<double, 2> east{};
    std::array<double, 2> north{};
    double lean_x = 0.0;
    double lean_y = 0.0;
    // The same for a step upwards, off the plane.
    std::array<double, 2> up{};
    double lean_up = 0.0;
    double pixels_per_metre = 1.0;  // seen head-on
    double height = 0.0;
    const Heightfield* terrain = nullptr;
    double terrain_error = 0.0;  // pixels that the place may be off the terrain
};

class Prepared {
public:
    virtual ~Prepared() = default;
    virtual PreparedCounts counts() const = 0;
    // The feature behind an id that draw_ids wrote, less one.
    virtual FeatureReference feature(uint32_t id) const = 0;
    // Every feature at a place, topmost first.
    virtual std::vector<FeatureReference> query(const SeenPoint& point) const = 0;
    // Adds what Technique::open needs, in sections whose names begin with `prefix`. They may point into this
    // object, which outlives the writing.
    virtual void save(ArchiveWriter& archive, const std::string& prefix) const = 0;
    // Whether anything is to be drawn: not where all features are fully transparent.
    virtual bool shows_anything() const = 0;
    // How a layer of so many features looks: all its colours and widths, of features without a decal 0.
    virtual LayerLook look_of(uint32_t layer, size_t features) const = 0;
    // The same features with other looks, of layers that it holds: a new index that shares whatever stays. Throws
    // Error(style) for what needs preparing anew, Error(unsupported) where the technique cannot.
    virtual std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                                     const MemoryAccount& memory) const = 0;
    // Opened from a file, and now given what it was made of: with it, so that it can be edited; null where that makes no
    // difference.
    virtual std::shared_ptr<const Prepared> with_sources(const TechniqueInput&) const { return nullptr; }
    // With features added, removed or replaced: a new index that shares whatever lies elsewhere. Throws
    // Error(unsupported) where the technique cannot or the index was opened from a file, Error(input),
    // Error(style), Error(memory).
    virtual std::shared_ptr<const Prepared> edited(const LayerEdit& edit,
                                                   const MemoryAccount& memory) const = 0;
};

// What a pixel shows of the picture.
enum class Antialias {
    none,      // its centre
    coverage,  // the mean over its area, worked out by the techniques
    ssaa,      // the mean of samples, each a whole picture
    msaa,      // the same, with the driver's samples as far as they go
    fxaa       // its centre, smoothed along the edges that the picture shows
};
// What antialias coverage is: the mean over the pixel's area, or what Thöny et al. 2018, section 3.5, estimate
// for lines.
enum class CoverageRule { exact, thoeny };

// Where the camera looks; the uniform block of every pass is bound already (shaders/shared/view_block.h).
struct View {
    int width = 0;  // of the whole picture, in pixels
    int height = 0;
    PositionGrid positions;
    Antialias antialias = Antialias::none;  // none or coverage: the others are made of pictures without
    double widest_pixel = 0.0;              // metres that the farthest pixel is wide, seen head-on
    double narrowest_pixel = 0.0;           // and the nearest
    double terrain_error = 0.0;             // pixels that the terrain's level of detail may be off
    CoverageRule coverage = CoverageRule::exact;
    const ViewBlock* block = nullptr;  // what the uniform block holds
    TimingLog* timings = nullptr;      // for passes of a technique's own; may be null
    // Whether the framebuffer holds what other techniques drew below: to be laid over. Else all of it is written.
    bool has_below = false;
};

// The terrain on the GPU. heights: R32F, metres at each sample (column, row), holes below -1e30.
struct TerrainView {
    const gl::Texture2D* heights = nullptr;
    const Heightfield* samples = nullptr;
};

// The surface seen at each pixel. position: block x, y and the bits of offset x, y
// (shaders/shared/position.glsl). surface: terrain gradient, distance along the pixel's ray. Without coverage,
// texels may have been gathered from anywhere in the picture: what they show follows from these two alone. depth:
// reversed, as attached to the G-buffer.
// `lens`: the share of each pixel that is inside the lens, and whether its centre is; null without one.
// `set_gathered`: for programs that include shared/gathered.glsl, where texels were gathered; else empty.
struct GBufferView {
    const gl::Texture2D* position = nullptr;
    const gl::Texture2D* surface = nullptr;
    const gl::Texture2D* depth = nullptr;
    const gl::Texture2D* lens = nullptr;
    std::function<void(gl::Program&)> set_gathered;
};

struct UpdateReport {
    uint64_t pieces = 0;
    uint64_t bytes = 0;         // of GL memory held by the technique
    uint64_t shader_steps = 0;  // the most a shader of this driver can take for one pixel; 0: no limit
    uint64_t longest_walk = 0;  // the most pieces that one point of a pixel has to look at
    std::vector<std::pair<std::string, double>> counts;  // further ones, for frame.stats
};

// What of `Technique::draw` follows from the slope of the ground, and not from the place on the map alone: nothing, how
// wide strokes are, or which strokes a pixel meets. With these, each sample of a pixel with a bend sees the facet that it lies
// on, and not that of a sample beside it.
enum class SlopeUse { none, widths, strokes };

class Technique {
public:
    virtual ~Technique() = default;
    virtual std::string name() const = 0;
    virtual std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                                       Progress& progress) const = 0;
    // What Prepared::save wrote. Arrays stay in the mapped file; `memory` is charged for those that do not.
    // Throws Error(file) for contents that no save wrote: afterwards, nothing in them can lead query, feature
    // or a shader astray.
    virtual std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                                 const MemoryAccount& memory) const = 0;
    // `lens`: what is seen inside the lens, `prepared` with other looks; null without one. A later call replaces
    // both, and uploads only what they do not share with those before. After an error nothing is uploaded.
    virtual void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                        const TerrainView& terrain, const MemoryAccount& memory) = 0;
    // Throws Error(unsupported) for a way of anti-aliasing that it cannot do.
    virtual UpdateReport update(const View& view) = 0;
    // Whether what the latest update made holds after the upload that followed: then the same view is not updated again.
    virtual bool keeps_update() const { return false; }
    // Drops what `update` keeps beyond the view that it was found for, for those who time it.
    virtual void forget_view() {}
    // Whether `draw` needs a depth attachment for itself, with whatever values.
    virtual bool needs_depth(const View&) const { return false; }
    // Whether `draw` and `draw_ids` need a depth attachment with a stencil.
    virtual bool needs_stencil(const View&) const { return false; }
    virtual SlopeUse slope_use() const { return SlopeUse::none; }
    // Writes premultiplied colour and coverage into the bound framebuffer, a rectangle of the picture: all of it,
    // or over what view.has_below says is there.
    virtual void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) = 0;
    // Writes 1 + id of the topmost feature at each pixel's centre, 0 where there is none.
    virtual void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) = 0;
};

// The techniques by name. Throws Error(input), which lists the names there are, for another one.
std::unique_ptr<Technique> make_technique(const std::string& name);
std::vector<std::string> technique_names();

}  // namespace decalgl
