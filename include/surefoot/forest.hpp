// The face of surefoot/forest, and core: extremely randomized trees, their files and their C.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/distill.hpp"
#include "surefoot/forest/export_c.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/permutation_importance.hpp"
#include "surefoot/forest/prune.hpp"
#include "surefoot/forest/serialize.hpp"
#include "surefoot/forest/shrink.hpp"
#include "surefoot/forest/training_report.hpp"
#include "surefoot/forest/wrap_around.hpp"
