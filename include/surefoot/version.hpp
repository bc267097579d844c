// Version of surefoot. Semantic versioning 2.0; CHANGELOG.md says what that covers.
//
//   #if SUREFOOT_VERSION >= 10200  // 1.2.0 or later
#pragma once

#define SUREFOOT_VERSION_MAJOR 0
#define SUREFOOT_VERSION_MINOR 1
#define SUREFOOT_VERSION_PATCH 0

// As one number: 10203 is 1.2.3. Minor and patch stay below 100.
#define SUREFOOT_VERSION (SUREFOOT_VERSION_MAJOR * 10000 + SUREFOOT_VERSION_MINOR * 100 + SUREFOOT_VERSION_PATCH)
