// Monitors of a calibrated walk: its model kept up to date, and an alarm that it has changed.
#pragma once

#include "surefoot/motion/monitor/alarm_threshold.hpp"
#include "surefoot/motion/monitor/change_alarm.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
