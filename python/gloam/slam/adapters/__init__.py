"""Programs that run SLAM methods, and the files that they share with the benchmark (contract.py)."""
