//! Awkward planets, settings and views: our layouts stand all of them, and where an older method does not, it is told.

mod stability {
    mod older;
    mod ours;
    mod warned;
}
