#include "io/config_file.h"
