#include "analysis/charge_motion.h"
