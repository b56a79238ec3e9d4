#include "diagnose/compare.h"
