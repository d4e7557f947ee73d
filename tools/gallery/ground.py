"""Honolulu, which the maps of the gallery are drawn on: its terrain, land cover and isolines."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import decalgl as dg
import honolulu

if TYPE_CHECKING:
    import geopandas as gpd

EYE = dg.Camera.look_at(honolulu.EYE, honolulu.TARGET, fov=honolulu.FIELD_OF_VIEW)
GROUND = dg.Relief(on_layers=0.5)
# What the valleys show most of.
KINDS = {
    "Ocean": "#a3c7dc",
    "Urban": "#e6d6c3",
    "Town": "#eee0cb",
    "Grassland": "#d5dca6",
    "Scrub": "#b4c792",
    "MixedForest": "#93b27a",
    "Stream": "#2f7fb8",
    "Road": "#fffdf7",
    "Freeway": "#e8924a",
}


@functools.cache
def terrain() -> dg.Terrain:
    return dg.Terrain.open(honolulu.DEM)


@functools.cache
def cover() -> gpd.GeoDataFrame:
    return honolulu.land_cover()


@functools.cache
def isolines(step: float) -> gpd.GeoDataFrame:
    return honolulu.isolines(terrain(), step)


def ground_scene(relief: dg.Relief = GROUND) -> dg.Scene:
    return dg.Scene(terrain(), exaggeration=honolulu.EXAGGERATION, relief=relief)
