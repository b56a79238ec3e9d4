#include "core/mill_shape.h"
