// The face of surefoot/optimize, and what it stands on: CMA-ES and least squares.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/cma_es_core.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"
#include "surefoot/optimize/coupled_dry_friction.hpp"
#include "surefoot/optimize/least_squares.hpp"
#include "surefoot/optimize/search_space.hpp"
