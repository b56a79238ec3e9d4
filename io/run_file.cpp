#include "io/run_file.h"
