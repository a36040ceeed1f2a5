//! Temporary: contact sheet.
fn main() {
    for n in std::env::args().skip(1) {
        let data = std::fs::read(format!("/tmp/gallery/{n}.gif")).unwrap();
        let mut o = gif::DecodeOptions::new();
        o.set_color_output(gif::ColorOutput::RGBA);
        let mut d = o.read_info(&data[..]).unwrap();
        let (w, h) = (u32::from(d.width()), u32::from(d.height()));
        let mut screen = vec![255u8; (w * h * 4) as usize];
        let mut all = vec![];
        while let Some(f) = d.read_next_frame().unwrap() {
            for y in 0..f.height as u32 {
                for x in 0..f.width as u32 {
                    let s = ((y * u32::from(f.width) + x) * 4) as usize;
                    let t = (((y + u32::from(f.top)) * w + x + u32::from(f.left)) * 4) as usize;
                    if f.buffer[s + 3] > 0 {
                        screen[t..t + 4].copy_from_slice(&f.buffer[s..s + 4]);
                    }
                }
            }
            all.push(screen.clone());
        }
        println!("{n} {w}x{h} {} frames", all.len());
        let mut sheet = tiny_skia::Pixmap::new(2 * w, 2 * h).unwrap();
        for (k, f) in [0, all.len() / 4, all.len() * 3 / 4, all.len() - 1].into_iter().enumerate() {
            let p = tiny_skia::PixmapRef::from_bytes(&all[f], w, h).unwrap();
            sheet.draw_pixmap(
                (k as u32 % 2 * w) as i32,
                (k as u32 / 2 * h) as i32,
                p,
                &Default::default(),
                Default::default(),
                None,
            );
        }
        sheet.save_png(format!("/tmp/gallery/frames-{n}.png")).unwrap();
    }
}
