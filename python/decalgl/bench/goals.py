"""The ratios by the names that they have in the records, the times that they come from, and their goals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .records import Record


@dataclass(frozen=True)
class Ratio:
    """A ratio of the records.

    source: what it is made of, to be formatted with its record.
    most, least: its goal, None where it has none.
    worst: the goal at the worst view, where that is another. scenes: those that the goal is set for.
    """

    source: str
    most: float | None = None
    least: float | None = None
    worst: float | None = None
    scenes: str = ""

    def goal(self, record: Record) -> str:
        """The goal in words, empty where there is none."""
        most, least = self._limits(record)
        return f"≤ {most:g}" if most is not None else f"≥ {least:g}" if least is not None else ""

    def reached(self, record: Record, value: float) -> bool | None:
        """Whether a record's ratio reaches the goal; None where there is none."""
        most, least = self._limits(record)
        if most is None and least is None:
            return None
        return (most is None or value <= most) and (least is None or value >= least)

    def _limits(self, record: Record) -> tuple[float | None, float | None]:
        if not record["scene"].startswith(self.scenes):
            return None, None
        most = self.worst if self.worst is not None and record["view"] == "worst" else self.most
        return most, self.least


RATIOS = {
    "P": Ratio("{preprocess_ms:.0f} ms ÷ radix sort {radix_sort_ms:.0f} ms", most=3.0),
    "bytes_per_segment": Ratio("{segments:,.0f} segments in {pieces:,.0f} pieces", most=32.0),
    "peak_memory": Ratio("{peak_bytes:,.0f} bytes ÷ input {input_bytes:,.0f} bytes", most=3.0),
    "open": Ratio("{open_ms:.0f} ms ÷ preparing {prepare_ms:.0f} ms", most=0.1),
    "levels_made": Ratio("{levels_ms:.0f} ms ÷ preparing {prepare_ms:.0f} ms"),
    "S": Ratio("{none_ms:.1f} ms ÷ floor {floor_ms:.1f} ms", most=5.0, worst=8.0),
    "S_levels": Ratio("{coverage_ms:.1f} ms ÷ floor {floor_ms:.1f} ms", most=5.0, worst=8.0),
    "AA": Ratio("{coverage_ms:.1f} ms ÷ {none_ms:.1f} ms", most=1.25),
    "levels": Ratio("{coverage_ms:.1f} ms ÷ coverage in the overview", most=1.0),
    "scale": Ratio("{scale_large_ms:.1f} ms ÷ {scale_small_ms:.1f} ms, none", most=1.2),
    "scale_coverage": Ratio(
        "{scale_coverage_large_ms:.1f} ms ÷ {scale_coverage_small_ms:.1f} ms, coverage", most=1.2
    ),
    "bvh_grid": Ratio("{technique} {bvh_ms:.0f} ms ÷ {grid_ms:.1f} ms", least=6.0, scenes="isolines"),
    "bvh_grid_min": Ratio("{technique}, of all views", least=6.0, scenes="isolines"),
    "bvh_grid_median": Ratio("{technique}, of all views", least=6.0, scenes="isolines"),
    "layer": Ratio("median step of frames", most=1.15),
    "empty": Ratio("{empty_ms:.0f} ms ÷ {ground_ms:.0f} ms", most=1.05),
    "interior": Ratio("{bands_none_ms:.1f} ms ÷ one rectangle {rectangle_none_ms:.1f} ms, none", most=1.1),
    "interior_coverage": Ratio(
        "{bands_coverage_ms:.1f} ms ÷ one rectangle {rectangle_coverage_ms:.1f} ms, coverage", most=1.1
    ),
    "opaque_stack": Ratio("{opaque_ms:.1f} ms ÷ side by side {disjoint_ms:.1f} ms", most=2.0),
    "sets": Ratio("{style_sets} style sets {sets_ms:.1f} ms ÷ one"),
    "drawn": Ratio("{style_sets} style sets {sets_ms:.1f} ms ÷ static lines {static_ms:.1f} ms"),
    "field_memory": Ratio("{field_bytes:,} bytes ÷ categories x pixels x targets x bytes", most=1.0),
    "restyle": Ratio("{restyle_ms:.1f} ms ÷ a frame of {frame_ms:.0f} ms", most=1.0),
    "filter": Ratio("{filter_ms:.1f} ms ÷ a frame of {frame_ms:.0f} ms", most=1.0),
    "edit": Ratio("{edit_ms:.1f} ms ÷ a frame of {frame_ms:.0f} ms", most=1.0),
    "lens": Ratio("{lens_ms:.1f} ms ÷ a frame of {frame_ms:.0f} ms"),
    "restyled": Ratio("{restyled_ms:.0f} ms ÷ a frame of {frame_ms:.0f} ms", most=2.0),
    "widen": Ratio("{widen_ms:.1f} ms ÷ a frame of {frame_ms:.0f} ms", most=1.0),
    "widened": Ratio("{widened_ms:.0f} ms ÷ a frame of {frame_ms:.0f} ms", most=2.0),
    "reorder": Ratio("{reorder_ms:.0f} ms ÷ a frame of {frame_ms:.0f} ms"),
    "ring": Ratio("{preprocess_ms:.0f} ms ÷ iso-bands {bands_ms:.0f} ms, by vertices", most=1.0),
    "style": Ratio("{style_ms:.1f} ms ÷ plain {plain_ms:.1f} ms"),
    "D": Ratio("lists {lists_ms:.0f} ms ÷ bins {bins_ms:.0f} ms", least=1.0, scenes="pixel lines"),
    "simplified": Ratio("all vertices {every_ms:.0f} ms ÷ those left {simple_ms:.0f} ms"),
    "elsewhere": Ratio(
        "a view beside all lines {elsewhere_ms:.0f} ms ÷ ground {ground_ms:.0f} ms", most=1.05
    ),
    "update_share": Ratio("{bins_update_ms:.0f} ms of {bins_ms:.0f} ms, bins"),
    "loops_detail": Ratio("half a pixel {half_ms:.1f} ms ÷ full detail {full_ms:.1f} ms"),
    "loops_static": Ratio("{half_ms:.1f} ms ÷ static {static_ms:.1f} ms"),
    "loops_standing": Ratio("without making cells, ÷ static {static_ms:.1f} ms"),
    "loops_seg_primitives": Ratio("{loops_primitives:,.0f} primitives ÷ segments of all levels"),
    "loops_seg_bytes": Ratio("{loops_bytes:,.0f} bytes ÷ segments in the index of LOCALIS"),
    "loops_seg_time": Ratio("{loops_ms:.1f} ms ÷ segments in the index of LOCALIS"),
    "loops_fitted_bytes": Ratio("{loops_bytes:,.0f} bytes ÷ the fitted index"),
    "loops_fitted_time": Ratio("{loops_ms:.1f} ms ÷ the fitted index"),
    "loops_P": Ratio("{loops_prepare_ms:.0f} ms ÷ radix sort {radix_sort_ms:.1f} ms"),
    "loops_bytes_per_segment": Ratio("{segments:,.0f} segments"),
    "mode": Ratio("frames of {mode_ms:.0f} ms ÷ {none_ms:.0f} ms"),
}
