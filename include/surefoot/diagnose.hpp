// The face of surefoot/diagnose: diagnosis of what a simulator leaves out.
#pragma once

#include "surefoot/core.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "surefoot/diagnose/simulator.hpp"
#include "surefoot/diagnose/text.hpp"
