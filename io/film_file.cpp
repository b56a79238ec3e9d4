#include "io/film_file.h"
