"""Error against run time, influence factors, scaling, stability and waste, as one page: `decalgl report --out DIR`.

    case_studies.py ─┐                                           ┌─▶ index.html, pictures/   opens without a network
    paths.py         ├─▶ parts: rows(context) ─▶ figures(rows) ──┼─▶ report.json             as of the benchmark
    settings.py     ─┘          part.py has the contract         └─▶ a CSV for each part

Every part is measured with the means of `decalgl.bench`: rounds in turns, medians with their spread. Errors are those
against `decalgl.reference`, and the same on every run.
"""
