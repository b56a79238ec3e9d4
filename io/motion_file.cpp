#include "io/motion_file.h"
