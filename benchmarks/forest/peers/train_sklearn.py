"""Trains scikit-learn's ExtraTreesRegressor on a file and prints: CPU seconds, R2 on another file, mean leaves per tree.

Files: float32, per sample the inputs and then the output. Usage: train_sklearn.py TRAIN TEST INPUTS TREES MIN_LEAF
"""
import sys
import time

import numpy as np
from sklearn.ensemble import ExtraTreesRegressor


def load(path, inputs):
    table = np.fromfile(path, dtype=np.float32).reshape(-1, inputs + 1)
    return np.ascontiguousarray(table[:, :inputs]), table[:, inputs].astype(np.float64)


train, test = sys.argv[1:3]
inputs, trees, min_leaf = map(int, sys.argv[3:6])
x, y = load(train, inputs)
forest = ExtraTreesRegressor(n_estimators=trees, min_samples_leaf=min_leaf, max_features=1.0, n_jobs=1, random_state=1)
start = time.process_time()
forest.fit(x, y)
seconds = time.process_time() - start
r2 = forest.score(*load(test, inputs))
leaves = np.mean([tree.get_n_leaves() for tree in forest.estimators_])
print(seconds, r2, leaves)
