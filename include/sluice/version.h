/** The version of these headers. The build reads it and stops if it disagrees with meson.build. */
#ifndef SLUICE_VERSION_H
#define SLUICE_VERSION_H

#define SLUICE_VERSION_MAJOR 0
#define SLUICE_VERSION_MINOR 1
#define SLUICE_VERSION_PATCH 0

#endif /* SLUICE_VERSION_H */
