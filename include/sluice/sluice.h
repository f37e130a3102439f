/** Every header that needs only libc. */
#ifndef SLUICE_SLUICE_H
#define SLUICE_SLUICE_H

#include <sluice/base.h>
#include <sluice/camera_motion.h>
#include <sluice/feedback_rate.h>
#include <sluice/heap.h>
#include <sluice/image.h>
#include <sluice/input.h>
#include <sluice/loader.h>
#include <sluice/manager.h>
#include <sluice/metrics.h>
#include <sluice/proxy.h>
#include <sluice/replay.h>
#include <sluice/udim.h>
#include <sluice/version.h>

#endif /* SLUICE_SLUICE_H */
