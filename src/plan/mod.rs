mod judge;
mod lab;
mod model;
