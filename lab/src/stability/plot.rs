//! A map as a picture.

use std::path::Path;

use plotters::prelude::*;

use super::Map;

const COLORS: [RGBColor; 4] = [
    RGBColor(200, 60, 40),
    RGBColor(220, 150, 0),
    RGBColor(110, 110, 110),
    RGBColor(20, 100, 190),
];

/// Writes the map as SVG into a folder: lines by formula, dots measured; what has no limit lies at the
/// upper edge.
pub fn save(map: &Map, folder: &Path) -> Result<(), String> {
    let file = folder.join(format!("{}.svg", map.name));
    draw(map, &file).map_err(|error| format!("{}: {error}", file.display()))
}

fn draw(map: &Map, file: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::new(file, (900, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let at: Vec<f64> = map.limits.iter().map(|limit| limit.at).collect();
    let low = at.iter().copied().fold(f64::MAX, f64::min) * 0.8;
    let high = at.iter().copied().fold(f64::MIN, f64::max) * 1.25;
    let least = map
        .limits
        .iter()
        .map(|limit| limit.measured)
        .fold(f64::MAX, f64::min);
    let mut chart = ChartBuilder::on(&root)
        .caption(map.title, ("sans-serif", 17))
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(80)
        .build_cartesian_2d(
            (low..high).log_scale(),
            (least * 0.5..map.most * 2.0).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc(map.across)
        .y_desc(map.up)
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .light_line_style(RGBColor(235, 235, 235))
        .draw()?;
    let mut methods: Vec<&str> = Vec::new();
    for limit in &map.limits {
        if !methods.contains(&limit.method) {
            methods.push(limit.method);
        }
    }
    for (i, method) in methods.iter().enumerate() {
        let color = COLORS[i % COLORS.len()];
        let own = || map.limits.iter().filter(|limit| limit.method == *method);
        // Where no formula is known, the line joins what was measured.
        let line = own().map(|limit| {
            let y = limit.predicted.unwrap_or(limit.measured);
            (limit.at, y.min(map.most))
        });
        let endless = own().all(|limit| limit.measured.is_infinite());
        let label = if endless {
            format!("{method}: no limit")
        } else {
            (*method).to_owned()
        };
        chart
            .draw_series(LineSeries::new(line, color.stroke_width(2)))?
            .label(label)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], color.stroke_width(2)));
        chart.draw_series(own().map(|limit| {
            let y = limit.measured.min(map.most);
            Circle::new((limit.at, y), 4, color.filled())
        }))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleLeft)
        .background_style(WHITE.mix(0.9))
        .border_style(RGBColor(200, 200, 200))
        .draw()?;
    root.present()?;
    Ok(())
}
