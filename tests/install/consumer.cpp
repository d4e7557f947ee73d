// Prepares a scene of one triangle; nothing here needs OpenGL.

#include <decalgl/frame/renderer.h>

#include <cstdio>
#ifdef HAS_GEO
#include <decalgl/geo/local_plane.h>
#endif

int main() {
    decalgl::Scene scene;
    scene.terrain = decalgl::Heightfield::flat({0.0, 0.0, 1000.0, 1000.0}, 10.0F);
    decalgl::Layer layer;
    layer.name = "triangle";
    layer.features = decalgl::Features::own(decalgl::FeatureKind::polygons, {100, 100, 900, 100, 500, 900},
                                            {0, 3}, {0, 1});
    layer.fill.colors = {200, 30, 30, 255};
    scene.layers.push_back(layer);
    decalgl::Renderer renderer;
    renderer.preprocess(scene);
#ifdef HAS_GEO
    const glm::dvec2 metres = decalgl::LocalPlane(8.54, 47.37).forward({8.55, 47.36});
    std::printf("%.3f %.3f\n", metres.x, metres.y);
#endif
    return 0;
}
