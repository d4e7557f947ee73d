"""Speed and memory on real data: `make bench`, or `python -m bench --help`."""
