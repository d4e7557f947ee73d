"""The blocks of the documentation: Markdown tables made of the records of a run.

A table is described by its columns, each a heading and a format of the record that a row is made of.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from .records import Record

    Results = Mapping[str, Any]
    Columns = Mapping[str, str]

TEXTS = ("scene", "view", "index", "artefact")
# The README leaves out the view from far away.
README_VIEWS = ("overview", "oblique", "close", "worst")

WHERE = {"scene": "{scene}", "view": "{view}"}
VIEWS = {
    **WHERE,
    "floor": "{floor_ms:.1f} ms",
    "`none`": "{none_ms:.1f} ms",
    "S": "{S:.1f}",
    "`coverage`": "{coverage_ms:.0f} ms",
    "S_levels": "{S_levels:.1f}",
    "AA": "{AA:.1f}",
}
SUMMARY = {
    **WHERE,
    "layers, `none`": "{none_ms:.0f} ms",
    "÷ floor": "{S:.1f}",
    "layers, `coverage`": "{coverage_ms:.0f} ms",
    "terrain and compose": "{coverage_ground_ms:.0f} ms",
}
PREPARED = {
    "scene": "{scene}",
    "segments": "{segments:,.0f}",
    "pieces": "{pieces:,.0f}",
    "preprocess": "{preprocess_ms:.0f} ms",
    "radix sort": "{radix_sort_ms:.1f} ms",
    "P": "{P:.1f}",
    "bytes a segment": "{bytes_per_segment:.1f}",
}
FILES = {
    "scene": "{scene}",
    "prepare": "{prepare_ms:.0f} ms",
    "save": "{save_ms:.0f} ms",
    "open": "{open_ms:.0f} ms",
    "levels of detail": "{levels_ms:.0f} ms",
}
MEMORY = {"peak ÷ input": "{peak_memory:.1f}", "quantum": "{quantum_mm:.1f} mm"}
INDEX = {"index": "`{technique}`"}
INDEXES = {
    **WHERE,
    **INDEX,
    "takes": "{bvh_ms:.0f} ms",
    "`grid`": "{grid_ms:.1f} ms",
    "÷ `grid`": "{bvh_grid:.1f}",
}
SCALE = {
    **WHERE,
    "`none`": "{scale_large_ms:.1f} ms",
    "÷ smallest": "{scale:.2f}",
    "`coverage`": "{scale_coverage_large_ms:.0f} ms",
    "÷ smallest, `coverage`": "{scale_coverage:.2f}",
}
STACKS = {
    "polygons": "{polygons}",
    "side by side": "{disjoint_ms:.1f} ms",
    "opaque": "{opaque_ms:.1f} ms",
    "÷ side by side": "{opaque_stack:.2f}",
    "alpha 0.5": "{half_ms:.1f} ms",
    "alpha 1/255": "{faint_ms:.1f} ms",
}
CHANGES = {
    **WHERE,
    "new colours": "{restyle:.2f}",
    "the picture after": "{restyled:.2f}",
    "other widths": "{widen:.2f}",
    "the picture after them": "{widened:.2f}",
    "a filter": "{filter:.2f}",
    "100 features moved": "{edit:.2f}",
    "a draw order": "{reorder:.2f}",
    "the lens moved, and drawn": "{lens:.2f}",
}
LOOKS = {"scene": "{scene}"} | {
    f"`{index}`, {view}": f"{{{index}_{view}}}"
    for index in ("grid", "bvh", "thoeny")
    for view in ("close", "oblique")
}
LOOPS_DRAWN = {
    "drawn by": "{by}",
    "primitives": "{loops_primitives:,.0f}",
    "÷ segments": "{loops_seg_primitives:.2f}",
    "references": "{loops_references:,.0f}",
    "memory": "{loops_bytes:,.0f}",
    "÷ replica": "{loops_seg_bytes:.2f}",
    "overview": "{overview_ms:.0f} ms",
    "oblique": "{oblique_ms:.0f} ms",
    "close": "{close_ms:.0f} ms",
    "worst": "{worst_ms:.0f} ms",
    "time ÷ replica": "{loops_seg_time:.2f}",
}
LOOPS_INDEXES = {
    "index": "`{by}`",
    "references": "{loops_references:,.0f}",
    "memory ÷ fitted": "{loops_fitted_bytes:.2f}",
    "time ÷ fitted": "{loops_fitted_time:.2f}",
}
LOOPS_DETAIL = {
    **WHERE,
    "active": "{active:,.0f}",
    "half a pixel": "{half_ms:.1f} ms",
    "of it cells": "{half_cells_ms:.1f} ms",
    "÷ full detail": "{loops_detail:.2f}",
    "÷ static": "{loops_static:.2f}",
    "standing ÷ static": "{loops_standing:.2f}",
    "terrain": "{half_terrain_ms:.1f} ms",
}
LOOPS_PREPARED = {
    "scene": "{scene}",
    "segments": "{segments:,.0f}",
    "preprocess": "{loops_prepare_ms:.0f} ms",
    "P": "{loops_P:.0f}",
    "bytes a segment": "{loops_bytes_per_segment:.0f}",
}

NETWORKS = {
    "roads": "{town}",
    "picture": "{picture}",
    "1 set": "{sets1[sets_ms]:.1f} ms",
    "2 ÷ 1": "{sets2[sets]:.2f}",
    "4 ÷ 1": "{sets4[sets]:.2f}",
    "8 ÷ 1": "{sets8[sets]:.2f}",
    "8 ÷ static lines": "{sets8[drawn]:.1f}",
}
FIELDS = {
    "roads": "{town}",
    "segments": "{segments:,}",
    "bits": "{bits}",
    "fields": "{field_bytes:,} bytes",
    "÷ formula": "{field_memory:.2f}",
    "buffers": "{bytes_per_segment_stored:.1f} bytes a segment",
}
CLIPMAP = {
    "lines": "{scene}",
    "solution": "{way}",
    "memory": "{prepared_megabytes:.2f} MB",
    "÷ least": "{least_memory:.2f}",
    "generate": "{generate_ms:.1f} ms",
    "another width": "{width_ms:.1f} ms",
    "tiles": "{tiles_ms:.0f} ms",
    "÷ fastest": "{least_tiles:.2f}",
    "wide alone": "{wide}",
    "thin alone": "{thin}",
    "picture": "{picture_ms:.0f} ms",
}
LINES = {"segments": "{segments:,.0f}"}
DYNAMIC = {
    **LINES,
    "picture": "{picture}",
    "view": "{view}",
    "bins": "{bins_ms:.0f} ms",
    "lists ÷ bins": "{lists_text}",
    "coverage ÷ none": "{coverage_text}",
    "update's share": "{update_share:.0%}",
}
DYNAMIC_STEPS = {
    **LINES,
    "view": "{view}",
    "simplify": "{share_simplify:.0%}",
    "compact vertices": "{share_compact_vertices:.0%}",
    "cull": "{share_cull:.0%}",
    "compact segments": "{share_compact_segments:.0%}",
    "project": "{share_project:.0%}",
    "into tiles": "{share_bins:.0%}",
    "drawing": "{share_drawing:.0%}",
}
DYNAMIC_SIMPLIFIED = {
    **LINES,
    "view": "{view}",
    "matched vertices": "{matched_vertices:,.0f}",
    "left by simplification": "{kept_vertices:,.0f}",
    "segments left by culling": "{seen_segments:,.0f}",
    "all vertices ÷ simplified, time": "{simplified:.2f}",
}
DYNAMIC_ELSEWHERE = {
    **LINES,
    "frame beside all lines, processor time": "{elsewhere_ms:.0f} ms",
    "÷ ground alone": "{elsewhere:.2f}",
}
DYNAMIC_MEMORY = {
    **LINES,
    "picture": "{picture}",
    "bins": "{megabytes:.0f} MB",
    "bytes a matched vertex": "{bins_bytes_per_vertex:.0f}",
    "bytes a pixel, bins": "{bins_bytes_per_pixel:.0f}",
    "bytes a pixel, lists": "{lists_pixel_text}",
}
ARTEFACTS = {"artefact": "{artefact}", "figure": "{figure:.3g} {unit}"}
VOLUMES = {
    "scene": "{scene}",
    "technique": "{way}",
    "memory": "{megabytes:.0f} MB",
    "prepare": "{prepare_ms:.0f} ms",
    "draw": "{draw_ms:.0f} ms",
    "groups": "{groups:.0f}",
}


def summary(results: Results) -> str:
    """For the README: isolines in milliseconds, then what preparing costs."""
    drawn = [record for record in _having(results, "S", "isolines") if record["view"] in README_VIEWS]
    costs = (
        "{scene}: {segments:,.0f} segments are prepared in {preprocess_ms:.0f} ms (the terrain in"
        " {preprocess_terrain_ms:.0f} ms) and take\n  {bytes_per_segment:.0f} bytes each; no vertex moves by"
        " more than {quantum_mm:.0f} mm"
    )
    prepared = _facts(_having(results, "P", "isolines"), costs)
    return "\n\n".join([_table(drawn, SUMMARY), prepared, machine(results)])


def ratios(results: Results) -> str:
    """Lines: the ratios and what they are made of."""
    return _of_contours(results, "isolines")


def polygons(results: Results) -> str:
    """The same of polygons."""
    return _of_contours(results, "iso-bands")


def indexes(results: Results) -> str:
    """The papers' indexes beside ours."""
    drawn, prepared = (_having(results, name, techniques=("bvh", "thoeny")) for name in ("bvh_grid", "P"))
    ranges = (
        "{scene}, `{technique}`: it takes {bvh_grid_min:.1f} times as long as `grid` at the least view,"
        " {bvh_grid_median:.1f} at the middle one"
    )
    tables = [_table(drawn, INDEXES), _table(prepared, {**INDEX, **PREPARED})]
    return "\n\n".join([*tables, _facts(prepared, ranges)])


def extremes(results: Results) -> str:
    """Large maps, many layers, large polygons and many of them."""
    facts = {
        "levels": "{scene}: coverage far away takes {levels:.2f} of the overview",
        "layer": "{scene}, {view}: one more layer takes {layer:.2f} of the frame, none {empty:.2f}",
        "interior": "{scene}, inside one: {interior:.2f} of a rectangle over the map,"
        " {interior_coverage:.2f} with coverage",
        "ring": "{scene} with {holes:,} holes: prepared in {preprocess_ms:.0f} ms, {ring:.2f} of iso-bands"
        " by vertices",
    }
    tables = [
        _table(_having(results, "open"), FILES),
        _table(_having(results, "scale"), SCALE),
        _table(_having(results, "opaque_stack"), STACKS),
        _table(_having(results, "S", "ring"), VIEWS),
    ]
    found = "\n".join(_facts(_having(results, name), text) for name, text in facts.items())
    return "\n\n".join(part for part in (*tables, found) if part)


def styles(results: Results) -> str:
    """Styles beside plain strokes and fills, and modes of anti-aliasing beside none."""
    drawn = _by_index(results, "style", "{style:.2f} ({style_ms:.1f} ms)")
    if not drawn:
        return "No figures yet."
    modes = _by_index(results, "mode", "{mode:.2f} ({mode_ms:.0f} ms)")
    return "\n\n".join([_table(drawn, LOOKS), _table(modes, LOOKS), machine(results, "960 x 540")])


def changes(results: Results) -> str:
    """What changes of a map take, in frames of the view."""
    return "\n\n".join(
        [_table(_having(results, "restyle", techniques=("static", "bvh")), CHANGES), machine(results)]
    )


def networks(results: Results) -> str:
    """Networks by distance fields: style sets by pictures, and memory."""
    drawn: dict[tuple[str, str], Record] = {}
    for one in _having(results, "sets", techniques=("distance_field",)):
        key = (one["town"], one["picture"])
        drawn.setdefault(key, {"town": key[0], "picture": key[1]})[f"sets{one['style_sets']}"] = one
    if not drawn:
        return "No figures yet."
    fields = _having(results, "field_memory", techniques=("distance_field",))
    return "\n\n".join([_table(list(drawn.values()), NETWORKS), _table(fields, FIELDS)])


def loops(results: Results) -> str:
    """Tables 2 and figure 16 of the paper, levels of detail, and what preparing costs."""
    found = [one for one in results["records"] if one["technique"].startswith("loops")]
    if not found:
        return "No figures yet."
    named = [{**one, "by": one["technique"].removeprefix("loops ")} for one in found]
    tables = (
        ("loops_seg_time", LOOPS_DRAWN),
        ("loops_fitted_time", LOOPS_INDEXES),
        ("loops_detail", LOOPS_DETAIL),
        ("loops_P", LOOPS_PREPARED),
    )
    made = [_table([one for one in named if value in one], columns) for value, columns in tables]
    return "\n\n".join([*made, machine(results)])


def clipmap(results: Results) -> str:
    """Sections 5.1 to 5.3 of the paper: each solution beside the best of its line set."""
    found = [one for one in results["records"] if one["technique"].startswith("clipmap ")]
    rows = []
    for one in found:
        same = [other for other in found if other["scene"] == one["scene"]]
        alone = {key: f"{one[key + '_ms']:.0f} ms" if key + "_ms" in one else "" for key in ("wide", "thin")}
        rows.append(
            {
                **one,
                **alone,
                "prepared_megabytes": one["prepared_bytes"] / 1e6,
                "least_memory": one["prepared_bytes"] / min(other["prepared_bytes"] for other in same),
                "least_tiles": one["tiles_ms"] / min(other["tiles_ms"] for other in same),
            }
        )
    return _table(rows, CLIPMAP) or "No figures yet."


def volumes(results: Results) -> str:
    """Figure 5.5 of the thesis: medians of all views."""
    found = [one for one in results["records"] if "way" in one and "groups" in one]
    return _table([{**one, "megabytes": one["bytes"] / 1e6} for one in found], VOLUMES) or "No figures yet."


def dynamic(results: Results) -> str:
    """Dynamic lines: methods, steps of the update, simplification, views beside all lines, memory."""
    found = [one for one in results["records"] if one["technique"] == "dynamic"]
    drawn = [_dynamic_texts(one) for one in found if "update_share" in one and "picture" in one]
    if not drawn:
        return "No figures yet."
    smallest = [one for one in drawn if one["picture"] == drawn[0]["picture"]]
    overview = [one for one in drawn if one["view"] == "overview"]
    tables = [
        _table(drawn, DYNAMIC),
        _table(smallest, DYNAMIC_STEPS),
        _table([one for one in found if "simplified" in one], DYNAMIC_SIMPLIFIED),
        _table([one for one in found if "elsewhere" in one], DYNAMIC_ELSEWHERE),
        _table(overview, DYNAMIC_MEMORY),
    ]
    return "\n\n".join(tables)


def _dynamic_texts(one: Record) -> Record:
    """A record with a dash in place of what was not measured."""

    def text(name: str, form: str) -> str:
        return format(one[name], form) if name in one else "–"

    return {
        **one,
        "lists_text": text("D", ".1f"),
        "coverage_text": text("filtered", ".1f"),
        "lists_pixel_text": text("lists_bytes_per_pixel", ".0f"),
        "share_drawing": 1.0 - one["update_share"],
        "megabytes": one["bins_bytes"] / 1e6,
    }


def artefacts(technique: str, results: Results) -> str:
    """What the artefacts of a technique come to."""
    found = [one for one in results["records"] if one["technique"] == technique and "artefact" in one]
    return _table(found, ARTEFACTS) or "No figures yet."


BLOCKS: dict[str, Callable[[Results], str]] = {
    "summary": summary,
    "ratios": ratios,
    "polygons": polygons,
    "indexes": indexes,
    "extremes": extremes,
    "styles": styles,
    "changes": changes,
    "networks": networks,
    "clipmap": clipmap,
    "volumes": volumes,
    "loops": loops,
    "dynamic": dynamic,
    **{
        f"{technique}_artefacts": partial(artefacts, technique)
        for technique in ("volume", "clipmap", "distance_field")
    },
}


def machine(results: Results, picture: str = "1920 x 1080") -> str:
    """One sentence: what the figures were measured on."""
    found = results["machine"]
    return (
        f"Measured on {found['cores']} cores of {_article(found['processor'])} with {found['driver']}, at"
        f" {picture}, as medians; runs: {results['runs']}."
    )


def _of_contours(results: Results, kind: str) -> str:
    drawn = _having(results, "S", kind)
    prepared = _having(results, "peak_memory", kind)
    return "\n\n".join([_table(drawn, VIEWS), _table(prepared, {**PREPARED, **MEMORY}), machine(results)])


def _having(
    results: Results, value: str, scenes: str = "", techniques: Sequence[str] = ("static",)
) -> list[Record]:
    """The records of some techniques with a value, of scenes that begin so."""
    records = [one for one in results["records"] if one["technique"] in techniques and value in one]
    return [one for one in records if one["scene"].startswith(scenes)]


def _by_index(results: Results, value: str, cell: str) -> list[Record]:
    """One record for all views and indexes of a scene, with a text for each; a dash where it was not measured."""
    found: dict[str, Record] = {}
    for one in _having(results, value, techniques=("static", "bvh", "thoeny")):
        index = "grid" if one["technique"] == "static" else one["technique"]
        empty = {**{column[1:-1]: "–" for column in LOOKS.values()}, "scene": one["scene"]}
        found.setdefault(one["scene"], empty)[f"{index}_{one['view']}"] = cell.format(**one)
    return list(found.values())


def _facts(records: list[Record], sentence: str) -> str:
    """A list with one item for each record."""
    return "\n".join(f"- {sentence.format(**record)}." for record in records)


def _table(records: Sequence[Record], columns: Columns) -> str:
    """Nothing where there is no record."""
    if not records:
        return ""
    rules = ["---" if heading in TEXTS else "---:" for heading in columns]
    rows = [[column.format(**record) for column in columns.values()] for record in records]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [list(columns), rules, *rows])


def _article(noun: str) -> str:
    return f"an {noun}" if noun[:1].upper() in "AEIOU" else f"a {noun}"
