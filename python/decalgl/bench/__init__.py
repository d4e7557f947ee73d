"""Speed and memory on real data: `make bench`, or `decalgl bench --help`.

    terrain ──▶ contours.py   isolines and iso-bands, kept on disk ───────┐
                shapes.py     one large ring, stacks of polygons          ├─▶ workload.py   scenes by size
                cameras.py    where from                                 ─┘        │
                                                                                   ▼
    bench/results/latest.json ◀── records.py ◀── measure.py ◀── suites/   one file a question
          │                                      times in turns
          ├──▶ terminal.py           the ratios beside their goals
          ├──▶ comparison.py         what got slower or larger since another run
          └──▶ docs.py, tables.py    the tables of the documentation

Each record is a scene, a technique and a view with its counts, its times in milliseconds and its ratios,
under the names that `goals.py` explains.
"""
