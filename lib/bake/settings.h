/** What settings stand for. */
#ifndef SLC_BAKE_SETTINGS_H
#define SLC_BAKE_SETTINGS_H

/** Part of every hash; raised when the same settings give other texels. */
#define SLC_BAKE_REVISION 2

#endif /* SLC_BAKE_SETTINGS_H */
