"""What programs rely on in the output of sluice-info --json: keys, types, and that it adds up."""

import json
import sys

TILE = 65536
NUMBERS = {
    "index", "sparseQueueFamilyIndex", "sparseQueueCount", "sparseAddressSpaceSize",
    "deviceLocalMemorySize", "maxSamplerAnisotropy", "maxImageExtent", "maxImageArrayLayers",
    "maxStorageBufferRange", "maxTouchedTiles", "timestampPeriod",
}
STRINGS = {"deviceName", "deviceType", "driverName", "driverInfo", "apiVersion", "missing"}
FLAGS = {
    "streams", "sparse", "dedicatedSparseQueue", "standardTiles", "residencyNonResidentStrict",
    "shaderResourceResidency", "residencyCodesExact", "shaderResourceMinLod",
    "sparseResidencyAliased", "sparseCubes", "timelineSemaphore", "fragmentStoresAndAtomics",
    "textureCompressionBC", "samplerAnisotropy",
}


def texel_bits(name):
    """From the name alone, so that it owes nothing to the library."""
    if name.startswith(("BC1", "BC4")):
        return 4
    if name.startswith("BC"):
        return 8
    if name.endswith("PACK32"):
        return 32
    channels = name.split("_")[0]
    return sum(int(n) for n in "".join(c if c.isdigit() else " " for c in channels).split())


def check_format(entry, device):
    assert entry["sparse"] <= entry["sampled"] and entry["sparse"] <= device["sparse"]
    if entry["sparse"]:
        texels = entry["tileWidth"] * entry["tileHeight"]
        assert texels * texel_bits(entry["format"]) == 8 * TILE, entry
    layout = entry.get("layout")
    if not layout:
        return 0
    assert layout["regularMipCount"] <= layout["mipLevelCount"]
    assert layout["tailSize"] <= layout["packedTileCount"] * TILE
    bits = layout["width"] * layout["height"] * texel_bits(entry["format"])
    assert layout["imageSize"] * 8 >= bits
    return 1


def main():
    lines = sys.stdin.read().splitlines()
    assert lines
    for line in lines:
        device = json.loads(line)
        assert set(device) == NUMBERS | STRINGS | FLAGS | {"formats"}, set(device)
        assert all(isinstance(device[k], (int, float)) for k in NUMBERS)
        assert all(isinstance(device[k], str) for k in STRINGS)
        assert all(isinstance(device[k], bool) for k in FLAGS)
        assert device["streams"] == (device["missing"] == "")
        layouts = sum(check_format(entry, device) for entry in device["formats"])
        assert not device["streams"] or layouts > 0
        print(device["deviceName"])


main()
