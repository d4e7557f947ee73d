// Products of two 32-bit differences, exactly: as one 64-bit integer in two words.

struct Wide {
    int high;
    uint low;
};

Wide difference_of_products(int a, int b, int c, int d) {
    int high1, low1, high2, low2;
    imulExtended(a, b, high1, low1);
    imulExtended(c, d, high2, low2);
    uint borrow;
    uint low = usubBorrow(uint(low1), uint(low2), borrow);
    return Wide(high1 - high2 - int(borrow), low);
}

Wide wide_cross(ivec2 a, ivec2 b) {
    return difference_of_products(a.x, b.y, a.y, b.x);
}

Wide wide_dot(ivec2 a, ivec2 b) {
    return difference_of_products(a.x, b.x, -a.y, b.y);
}

float magnitude(Wide value) {
    bool negative = value.high < 0;
    uint low = negative ? ~value.low + 1u : value.low;
    int high = negative ? ~value.high + int(low == 0u) : value.high;
    return float(high) * 4294967296.0 + float(low);
}
