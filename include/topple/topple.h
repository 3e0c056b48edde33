/// All of Topple.
#pragma once

#include "topple/base.h"        // IWYU pragma: export
#include "topple/export.h"      // IWYU pragma: export
#include "topple/layout.h"      // IWYU pragma: export
#include "topple/measure.h"     // IWYU pragma: export
#include "topple/model.h"       // IWYU pragma: export
#include "topple/picture.h"     // IWYU pragma: export
#include "topple/profile.h"     // IWYU pragma: export
#include "topple/recording.h"   // IWYU pragma: export
#include "topple/run.h"         // IWYU pragma: export
#include "topple/sweep.h"       // IWYU pragma: export
#include "topple/validation.h"  // IWYU pragma: export
