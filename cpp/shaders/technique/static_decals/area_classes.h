// How the pixels of a filtered picture are drawn. Each class is a pass of its own, kept to its pixels by an early depth test
// against what the pass before them wrote. Read by C++ and GLSL alike.
#ifndef DECALGL_AREA_CLASSES_H
#define DECALGL_AREA_CLASSES_H

#define CLASS_DONE 1.0    // everything seen covers all of the pixel, and is drawn already
#define CLASS_CELLS 0.75  // 64 samples together, cell by cell
#define CLASS_POINTS 0.5  // 64 or 256 samples, each by itself: the pixel spans many cells

#endif
