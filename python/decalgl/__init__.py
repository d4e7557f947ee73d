"""decalgl: very large 2D vector maps, draped exactly on 3D terrain at the resolution of the screen.

import decalgl as dg

terrain = dg.Terrain.open("dem.tif")
scene = dg.Scene(terrain)
scene.add_polygons("landcover.gpkg", column="kind", cmap="Greens")
scene.add_lines("roads.gpkg", color="crimson", width=6, width_units="m")
scene.render(scene.home(), size=(1920, 1080)).save("map.png")
"""

from ._core import __version__
from .camera import Camera
from .coloring import Coloring
from .distance_field import DistanceField
from .doctor import Diagnosis, doctor
from .dynamic import Dynamic
from .errors import (
    CancelledError,
    ColumnError,
    CrsError,
    DecalError,
    DecalWarning,
    FileError,
    GraphicsError,
    InputError,
    MemoryLimitError,
    StyleError,
    UnsupportedError,
)
from .features import FeatureTable
from .frame import Frame, Picked, PreparedLayer, Stats
from .indexes import BvhIndex
from .layer import Layer
from .lens import Lens
from .loops import Detail, Loops, LoopsBvh
from .networks import Lod, NetworkCategory, NetworkStyle
from .patterns import Pattern
from .renderer import Renderer
from .road_styles import road_styles
from .scene import Relief, Scene
from .scene_file import load_scene
from .strokes import Hatch
from .styles import Casing, Outline
from .techniques import Static, Technique
from .terrain import Terrain
from .volume import Volume

__all__ = [
    "BvhIndex",
    "Camera",
    "CancelledError",
    "Casing",
    "Coloring",
    "ColumnError",
    "CrsError",
    "DecalError",
    "DecalWarning",
    "Detail",
    "Diagnosis",
    "DistanceField",
    "Dynamic",
    "FeatureTable",
    "FileError",
    "Frame",
    "GraphicsError",
    "Hatch",
    "InputError",
    "Layer",
    "Lens",
    "Lod",
    "Loops",
    "LoopsBvh",
    "MemoryLimitError",
    "NetworkCategory",
    "NetworkStyle",
    "Outline",
    "Pattern",
    "Picked",
    "PreparedLayer",
    "Relief",
    "Renderer",
    "Scene",
    "Static",
    "Stats",
    "StyleError",
    "Technique",
    "Terrain",
    "UnsupportedError",
    "Volume",
    "__version__",
    "doctor",
    "load_scene",
    "road_styles",
]
