"""The command line: decalgl render | info | doctor | bench | report.

    decalgl render scene.toml -o map.png --view valley
    decalgl render --dem dem.tif --polygons cover.gpkg --column kind --lines roads.gpkg --width 6 -o map.png
    decalgl info dem.tif
    decalgl doctor
    decalgl bench --compare before.json after.json
    decalgl report --out build/report --size quick

Results go to standard output, progress and messages to standard error. Exit codes: 0 done, 1 the doctor found
nothing that can draw or a comparison something worse, 2 an error (one line; --debug shows where), 130
cancelled with Ctrl-C.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from . import _describe, _drawing
from .errors import CancelledError, DecalError, FileError, InputError
from .frame import picture_format

app = typer.Typer(
    help="Vector maps drawn exactly on terrain.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
messages = Console(stderr=True, soft_wrap=True, highlight=False)

Files = list[Path] | None
Words = list[str] | None
Text = str | None


@app.callback()
def options(
    debug: Annotated[bool, typer.Option("--debug", help="Show where an error came from.")] = False,
) -> None:
    """Vector maps drawn exactly on terrain."""
    # `main` looks for --debug by itself, as errors can come before this runs.
    del debug


@app.command()
def render(
    scene_file: Annotated[
        Path | None, typer.Argument(help="A scene file (TOML).", show_default=False)
    ] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="The picture to write.")] = None,
    view: Annotated[Text, typer.Option(help="A view of the scene file.")] = None,
    size: Annotated[Text, typer.Option(help="Pixels, such as 1920x1080.")] = None,
    antialias: Annotated[Text, typer.Option(help="none, coverage, ssaa, msaa or fxaa.")] = None,
    samples: Annotated[
        int | None, typer.Option(help="Samples a pixel of ssaa and msaa: 1, 2, 4, 8, 16 or 32.")
    ] = None,
    background: Annotated[Text, typer.Option(help="sky, a colour, or none for transparent.")] = None,
    dem: Annotated[Path | None, typer.Option(help="A terrain raster, instead of a scene file.")] = None,
    exaggeration: Annotated[
        float | None, typer.Option(help="Heights are multiplied by it, with --dem.")
    ] = None,
    polygons: Annotated[Files, typer.Option(help="A vector file of polygons; may be repeated.")] = None,
    lines: Annotated[
        Files, typer.Option(help="A vector file of lines, above the polygons; may be repeated.")
    ] = None,
    crs: Annotated[Text, typer.Option(help="The CRS of vector files that name none.")] = None,
    column: Annotated[
        Text, typer.Option(help="Colours polygons (lines, if there are none) by a column.")
    ] = None,
    cmap: Annotated[Text, typer.Option(help="The colormap for --column.")] = None,
    color: Annotated[
        Text, typer.Option(help="The colour of all layers that --column does not colour.")
    ] = None,
    width: Annotated[float | None, typer.Option(help="The width of lines in metres.")] = None,
    eye: Annotated[Text, typer.Option(help="x,y,z in metres; with --target.")] = None,
    target: Annotated[Text, typer.Option(help="x,y,z in metres; with --eye.")] = None,
    fov: Annotated[float | None, typer.Option(help="Vertical field of view in degrees, with --eye.")] = None,
    top_down: Annotated[
        bool, typer.Option("--top-down", help="Look straight down on the whole terrain.")
    ] = False,
    terrain_error: Annotated[
        float | None, typer.Option(help="Pixels the terrain may be off; 0 draws every sample.")
    ] = None,
    memory_limit: Annotated[Text, typer.Option(help="Such as 800MB or 2GB.")] = None,
    backend: Annotated[Text, typer.Option(help="auto, egl or osmesa.")] = None,
    cache: Annotated[
        Path | None,
        typer.Option(help="A file that keeps the prepared scene, so that the next picture of it is quick."),
    ] = None,
    index: Annotated[Text, typer.Option(help="grid, bvh or thoeny: how static layers are found.")] = None,
    stats: Annotated[bool, typer.Option("--stats", help="Print what the picture cost.")] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="No progress bars.")] = False,
) -> None:
    """Draw a picture of a scene file, or of a terrain and vector files."""
    target_file = _check_output(output)
    flags = _drawing.Flags(
        dem, exaggeration, tuple(polygons or ()), tuple(lines or ()), crs, column, cmap, color, width
    )
    place = _drawing.Place(view, _triple(eye, "--eye"), _triple(target, "--target"), fov, top_down)
    picture = _drawing.Picture(
        size=None if size is None else parse_size(size),
        antialias=antialias,
        background=background,
        renderer=_given(
            terrain_error=terrain_error,
            memory_limit=None if memory_limit is None else parse_bytes(memory_limit),
            backend=backend,
            cache=cache,
            index=index,
            samples=samples,
        ),
    )
    with _drawing.ProgressBars(messages, hidden=quiet) as bars:
        frame = _drawing.draw(scene_file, flags, place, picture, bars)
    frame.save(target_file)
    if stats:
        Console().print(_describe.cost_table(frame.stats.to_dict()))
    messages.print(f"Wrote {target_file}", markup=False)


@app.command()
def info(
    file: Annotated[Path, typer.Argument(help="A raster, a vector file, a scene file or a cache.")],
) -> None:
    """Say what a file holds, without reading all of it."""
    console = Console(highlight=False)
    for table in _describe.describe(file):
        console.print(table)


@app.command()
def doctor() -> None:
    """Say what can draw on this machine, and what to install where nothing can."""
    import decalgl

    records = list(decalgl.doctor())
    table = Table("", "what", "found", "what to do")
    for record in records:
        mark = "[green]ok[/green]" if record.ok else "[red]no[/red]"
        cells = (record.name, record.detail, "" if record.ok else record.cure)
        table.add_row(mark, *(_plain(cell) for cell in cells))
    Console().print(table)
    if not any(record.ok for record in records):
        messages.print("Nothing here can draw.", style="bold red")
        raise typer.Exit(1)


@app.command()
def bench(
    size: Annotated[Words, typer.Option(help="1M, 5M or 31M; may be repeated. All by default.")] = None,
    suite: Annotated[Words, typer.Option(help="What to ask; may be repeated. All by default.")] = None,
    runs: Annotated[int, typer.Option(help="Rounds of which the medians are taken.")] = 5,
    out: Annotated[Path | None, typer.Option(help="The file of results to write.")] = None,
    docs: Annotated[bool, typer.Option("--docs", help="Only write the last results into the docs.")] = False,
    compare: Annotated[
        tuple[Path, Path] | None, typer.Option(help="Two files of results: what got worse from A to B?")
    ] = None,
) -> None:
    """Measure speed and memory on real data, or compare the results of two runs."""
    from .bench import command

    if compare is not None:
        raise typer.Exit(0 if command.compare(*compare) else 1)
    if docs:
        command.write_docs()
    else:
        command.measure_all(size or [], suite or [], runs, out)


@app.command()
def report(
    out: Annotated[Path, typer.Option(help="The folder to write: index.html, report.json, CSVs, pictures.")],
    size: Annotated[str, typer.Option(help="quick (some minutes, no network) or full (hours).")] = "quick",
    part: Annotated[Words, typer.Option(help="What to measure; may be repeated. All by default.")] = None,
    step: Annotated[
        Text,
        typer.Option(help="Of the scenes: offline, small, medium or large. By default as fits the size."),
    ] = None,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume", help="Keep what an earlier run of this commit measured into the same folder."
        ),
    ] = False,
    redraw: Annotated[bool, typer.Option("--redraw", help="Only make the page of what is there.")] = False,
    docs: Annotated[bool, typer.Option("--docs", help="Only take what is there over into the docs.")] = False,
) -> None:
    """Measure error against run time and more, and write a page with plots that opens offline."""
    from .report import command

    if not docs:
        page = command.write(out) if redraw else command.make(out, size, part or [], step, resume)
        messages.print(f"Wrote {page}", markup=False)
        return
    from .report.docs import update

    for path in update(out):
        messages.print(f"Wrote {path}", markup=False)


def parse_size(text: str) -> tuple[int, int]:
    """(width, height) in pixels of a text such as 1920x1080. Raises InputError."""
    parts = text.lower().replace("×", "x").split("x")
    if len(parts) != 2 or not all(part.strip().isdecimal() and int(part) > 0 for part in parts):
        raise InputError(
            f"--size {text!r} is not a size in pixels. Write it as WIDTHxHEIGHT, such as 1920x1080."
        )
    return int(parts[0]), int(parts[1])


def parse_bytes(text: str) -> int:
    """Bytes of a text such as 800MB, 2GB, 1.5GiB or a plain number. Raises InputError."""
    units = {"": 1, "b": 1, "kb": 10**3, "mb": 10**6, "gb": 10**9, "kib": 2**10, "mib": 2**20, "gib": 2**30}
    stripped = text.strip().lower()
    number = stripped.rstrip("abcdefghijklmnopqrstuvwxyz")
    unit = stripped[len(number) :]
    try:
        count = float(number) * units[unit]
        if not 1 <= count < 2**63:
            raise ValueError
    except (KeyError, ValueError):
        raise InputError(
            f"--memory-limit {text!r} is not an amount of memory. Write it as 800MB or 2GB."
        ) from None
    return int(count)


def _triple(text: str | None, option: str) -> tuple[float, float, float] | None:
    if text is None:
        return None
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"{option} {text!r} is not a position. Write it as x,y,z in metres.") from None
    return x, y, z


def _check_output(output: Path | None) -> Path:
    """The path, after the checks that would otherwise come only when all is drawn."""
    if output is None:
        raise InputError("No picture is named. Add -o map.png.")
    if output.is_dir():
        raise FileError(f"'{output}' is a folder. Name a file in it.")
    if not output.absolute().parent.is_dir():
        raise FileError(
            f"There is no folder '{output.absolute().parent}'. Make it first, or name another place."
        )
    picture_format(output)
    return output


def _given(**values: Any) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value is not None}


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    messages.print(f"[yellow]warning:[/yellow] {_plain(message)}")


def _plain(message: object) -> str:
    """Text in which brackets are no markup."""
    return str(message).replace("[", "\\[")


def run(arguments: list[str]) -> int:
    """Runs one command line and gives the exit code; errors become one line each."""
    command = typer.main.get_command(app)
    try:
        command.main(arguments, prog_name="decalgl")
    except SystemExit as ending:
        return ending.code if isinstance(ending.code, int) else int(ending.code is not None)
    except (CancelledError, KeyboardInterrupt):
        messages.print("Cancelled.")
        return 130
    except DecalError as error:
        if "--debug" in arguments:
            messages.print_exception()
        messages.print(f"[bold red]error:[/bold red] {_plain(error)}")
        return 2
    return 0


def main() -> None:
    """The entry point of the command `decalgl`."""
    warnings.showwarning = _show_warning
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
