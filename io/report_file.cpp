#include "io/report_file.h"
